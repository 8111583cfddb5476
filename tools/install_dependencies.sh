#!/usr/bin/env bash
# install_dependencies.sh run|test|lint: what the build, the tests or `make lint` need on Debian 12, if it is missing.
set -euo pipefail

# Boost is named by its version: 1.81 conflicts with Debian's default 1.74.
run_packages=(make g++ cmake ninja-build pkg-config libboost1.81-dev libfmt-dev nlohmann-json3-dev libcli11-dev
  libedit-dev libudev-dev libavahi-client-dev zlib1g-dev libzstd-dev libxxhash-dev libsqlite3-dev libsqlitecpp-dev
  libsystemd-dev libcairo2-dev fonts-dejavu-core)
test_packages=(ccache libgtest-dev libgmock-dev librapidcheck-dev python3 clang-19 libclang-rt-19-dev
  clang-format-19 chromium)
lint_packages=(clang-tidy-19 git)

case "${1:-}" in
  run) wanted=("${run_packages[@]}") ;;
  test) wanted=("${run_packages[@]}" "${test_packages[@]}") ;;
  lint) wanted=("${run_packages[@]}" "${test_packages[@]}" "${lint_packages[@]}") ;;
  *)
    echo "usage: $0 run|test|lint" >&2
    exit 1
    ;;
esac

# The page is built with Node, and an independent sender in tests/live runs on it, wherever it comes from.
if ! { command -v node && command -v npm; } >/dev/null; then
  wanted+=(nodejs npm)
fi

missing=()
for package in "${wanted[@]}"; do
  [[ $(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) == installed ]] || missing+=("$package")
done
[[ ${#missing[@]} -eq 0 ]] && exit 0

as_root=()
if [[ $(id -u) -ne 0 ]]; then
  if ! command -v sudo >/dev/null; then
    echo "Missing packages and no sudo to install them. As root: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
echo "Installing: ${missing[*]}"
"${as_root[@]}" apt-get update -q
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
