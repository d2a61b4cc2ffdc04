#!/usr/bin/env bash
# Runs the test of the Blender add-on: run_tests.sh VANTAGE. Says SKIPPED without Blender, NumPy or Pillow.
set -euo pipefail
python=/usr/bin/python3
if ! command -v blender >/dev/null; then
  echo "SKIPPED: the Blender add-on: there is no blender (package blender)"
  exit 0
fi
for package in numpy PIL; do
  if ! "$python" -c "import $package" 2>/dev/null; then
    echo "SKIPPED: the Blender add-on: $package is missing (packages python3-numpy and python3-pil)"
    exit 0
  fi
done
cd "$(dirname "$0")"
VANTAGE=$(realpath "$1") exec "$python" -B -m unittest --quiet import_test
