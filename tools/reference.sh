#!/usr/bin/env bash
# Writes the pages of docs/reference from the programs' own tables; see tools/reference.py.
#   tools/reference.sh [PROGRAMS]            PROGRAMS: their folder, build/release/bin by default
#   tools/reference.sh --check [PROGRAMS]    fails if a page is not what the programs say; says SKIPPED without python3
set -euo pipefail
cd "$(dirname "$0")/.."
check=false
if [ "${1:-}" = --check ]; then
  check=true
  shift
fi
programs=$(realpath "${1:-build/release/bin}")
if ! command -v python3 >/dev/null; then
  echo "SKIPPED: reference: there is no python3 (package python3)"
  exit 0
fi
if ! $check; then
  tools/reference.py "$programs" docs/reference
  exit
fi
made=$(mktemp -d)
trap 'rm -rf "$made"' EXIT
tools/reference.py "$programs" "$made"
if ! diff -ru docs/reference "$made"; then
  echo "FAILED  docs/reference is not what the programs say; run tools/reference.sh and commit the pages"
  exit 1
fi
echo "reference: $(find "$made" -name '*.md' | wc -l) pages are what the programs say"
