#!/usr/bin/env bash
# build_page.sh OUT: builds the page in web/ and writes it to OUT as sources of a program (tools/embed_page.mjs).
set -euo pipefail
out=$(realpath -m "$1")
here=$(realpath "$(dirname "$0")")
"$here/in_web.sh" npm run --silent build
"$here/in_web.sh" node "$here/embed_page.mjs" dist "$out"
