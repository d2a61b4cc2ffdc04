#!/usr/bin/env bash
# Runs clang-tidy with .clang-tidy over the C++ files that changed since a revision, or over all.
#   tools/tidy.sh [REVISION]
set -euo pipefail
cd "$(dirname "$0")/.."
tools/build.sh release
files=$(if [ $# -gt 0 ]; then git diff --name-only --diff-filter=d "$1" -- '*.cpp'; else git ls-files '*.cpp'; fi)
printf '%s\n' $files | grep -vE '^$' | xargs -r -P "$(nproc)" -n 1 clang-tidy -p build/release --quiet --extra-arg=-Wno-unknown-warning-option
