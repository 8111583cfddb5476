#!/usr/bin/env bash
# run.sh OUT [ARGUMENTS]: the browser tests, against the program that $KERF names; what a failed one leaves goes to OUT.
set -euo pipefail
out=$(realpath -m "$1")
here=$(realpath "$(dirname "$0")")
shift
# shellcheck source=/dev/null
export NODE_PATH=$here/../../web/node_modules KERF_BROWSER_OUT=$out
exec node "$NODE_PATH/@playwright/test/cli.js" test --config "$here/playwright.config.ts" "$@"
