#!/usr/bin/env bash
# Runs the tests of the Python module: run_tests.sh SOURCES. Says SKIPPED without NumPy or Pillow.
set -euo pipefail
python=/usr/bin/python3
for package in numpy PIL; do
  if ! "$python" -c "import $package" 2>/dev/null; then
    echo "SKIPPED: the Python module: $package is missing (packages python3-numpy and python3-pil)"
    exit 0
  fi
done
cd "$(dirname "$0")"
exec "$python" -m unittest --quiet module_test "${@:2}"
