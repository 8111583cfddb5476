#!/usr/bin/env bash
# install.sh DIR: cncjs in DIR, exactly as package-lock.json says; nothing to do if it is there already. Its install
# scripts do not run: its serial port library ships its binaries inside the package.
set -euo pipefail
source=$(cd "$(dirname "$0")" && pwd)
cmp -s "$source/package-lock.json" "$1/installed" && exit 0
mkdir -p "$1"
cp "$source/package.json" "$source/package-lock.json" "$1"
cd "$1"
npm ci --ignore-scripts --no-audit --no-fund --loglevel=error --fetch-retries=4
cp package-lock.json installed
