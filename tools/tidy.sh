#!/usr/bin/env bash
# Runs clang-tidy with .clang-tidy over the C++ files that changed since a revision, or over all.
#   tools/tidy.sh [REVISION]
set -euo pipefail
cd "$(dirname "$0")/.."
tools/build.sh release
# Without the precompiled headers of another compiler; so what a file forgot to include shows as well.
mkdir -p build/tidy
sed -E 's# -(Winvalid-pch|fpch-preprocess)##g; s# -include [^ "]*cmake_pch\.hxx##g' build/release/compile_commands.json \
  >build/tidy/compile_commands.json
files=$(if [ $# -gt 0 ]; then git diff --name-only --diff-filter=d "$1" -- '*.cpp'; else git ls-files '*.cpp'; fi)
printf '%s\n' $files | grep -vE '^$' | xargs -r -P "$(nproc)" -n 1 clang-tidy -p build/tidy --quiet --extra-arg=-Wno-unknown-warning-option
