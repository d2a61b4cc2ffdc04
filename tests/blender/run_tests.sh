#!/usr/bin/env bash
# Runs the test of the Blender add-on: run_tests.sh VANTAGE. Says SKIPPED without Blender, NumPy or Pillow.
set -euo pipefail
if ! command -v blender >/dev/null; then
  echo "SKIPPED: the Blender add-on: there is no blender (package blender)"
  exit 0
fi
vantage=$(realpath "$1")
cd "$(dirname "$0")"
. ../support/python_packages.sh
skip_without_pictures 'the Blender add-on'
VANTAGE=$vantage exec "$python" -B -m unittest --quiet import_test
