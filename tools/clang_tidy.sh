#!/usr/bin/env bash
# clang_tidy.sh BUILD [SINCE]: clang-tidy over every source in BUILD's compile commands, or over those that changed
# since the commit SINCE (a changed header counts through the sources beside it that bear its name).
set -euo pipefail
cd "$(dirname "$0")/.."
build=$1
since=${2:-}

if [[ -z $since ]]; then
  sources=$(find . -path ./build -prune -o -name '*.cpp' -print | sed 's|^\./||')
else
  sources=$({ git diff --name-only --diff-filter=d "$since"; git ls-files --others --exclude-standard; } |
    sed -nE 's/\.[ch]pp$//p' | sed 's/_test$//' | sort -u |
    while read -r stem; do ls "$stem.cpp" "${stem}_test.cpp" 2>/dev/null || true; done)
fi
known=$(for source in $sources; do
  if grep -qF "$PWD/$source\"" "$build/compile_commands.json"; then echo "$source"; fi
done)
[[ -n $known ]] || { echo "clang-tidy: nothing to check"; exit 0; }
echo "clang-tidy: $(wc -l <<<"$known") sources"
# Its standard error only counts the warnings that it left out; findings come on standard output.
xargs -P "$(nproc)" -n 1 clang-tidy-19 -p "$build" --quiet <<<"$known" 2>"$build/clang_tidy.log"
echo "clang-tidy: nothing found"
