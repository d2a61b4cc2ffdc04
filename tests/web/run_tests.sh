#!/usr/bin/env bash
# Runs the tests of the page for tablets: run_tests.sh VANTAGE. Says SKIPPED without Chromium, NumPy or Pillow.
set -euo pipefail
python=/usr/bin/python3
if ! command -v chromium >/dev/null && ! command -v chromium-browser >/dev/null; then
  echo "SKIPPED: the page for tablets: there is no Chromium (package chromium)"
  exit 0
fi
for package in numpy PIL; do
  if ! "$python" -c "import $package" 2>/dev/null; then
    echo "SKIPPED: the page for tablets: $package is missing (packages python3-numpy and python3-pil)"
    exit 0
  fi
done
VANTAGE=$(realpath "$1")
export VANTAGE
cd "$(dirname "$0")"
exec "$python" -B page_test.py "${@:2}"
