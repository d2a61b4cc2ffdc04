#!/usr/bin/env bash
# Runs the tests of the Python module: run_tests.sh SOURCES. Says SKIPPED without NumPy or Pillow.
set -euo pipefail
cd "$(dirname "$0")"
. ../support/python_packages.sh
skip_without_pictures 'the Python module'
exec "$python" -m unittest --quiet module_test "${@:2}"
