#!/usr/bin/env bash
# in_web.sh COMMAND…: runs a command in web/, with what web/package-lock.json names installed and a Node that is new
# enough: the page's tools need 20, and Debian 12 has 18.
set -euo pipefail
cd "$(dirname "$0")/../web"

if [[ $(node --version | sed 's/^v//; s/\..*//') -lt 20 ]]; then
  node20=../build/node20
  [[ -x $node20/node_modules/.bin/node ]] || npm install --silent --no-save --prefix "$node20" node@20
  PATH=$(realpath "$node20")/node_modules/.bin:$PATH
fi

# One at a time: two build folders may want it at once.
mkdir -p ../build
(
  flock 9
  if [[ ! -e node_modules/.package-lock.json || package-lock.json -nt node_modules/.package-lock.json ]]; then
    npm ci --no-audit --no-fund
  fi
) 9>../build/page.lock
exec "$@"
