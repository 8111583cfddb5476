#!/usr/bin/env bash
# build_page.sh OUT: builds the page in web/ and writes it to OUT as sources of a program (tools/embed_page.mjs).
set -euo pipefail
out=$(realpath -m "$1")
cd "$(dirname "$0")/../web"

# What the page is built with needs Node 20, and Debian 12 has 18.
if [[ $(node --version | sed 's/^v//; s/\..*//') -lt 20 ]]; then
  node20=../build/node20
  [[ -x $node20/node_modules/.bin/node ]] || npm install --silent --no-save --prefix "$node20" node@20
  PATH=$(realpath "$node20")/node_modules/.bin:$PATH
fi

# One build at a time: two build folders may want it at once.
mkdir -p ../build
exec 9>../build/page.lock
flock 9
if [[ ! -e node_modules/.package-lock.json || package-lock.json -nt node_modules/.package-lock.json ]]; then
  npm ci --no-audit --no-fund
fi
npm run --silent build
node ../tools/embed_page.mjs dist "$out"
