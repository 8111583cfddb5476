#!/usr/bin/env bash
# format.sh [--check]: clang-format over every C++ file of the tree; with --check it only says what is not in form.
set -euo pipefail
cd "$(dirname "$0")/.."
mode=(-i)
[[ "${1:-}" == --check ]] && mode=(--dry-run -Werror)
find . -path './.*' -prune -o -path ./build -prune -o -name '*.[ch]pp' -print0 |
  xargs -0 -r clang-format-19 "${mode[@]}"
