#!/usr/bin/env bash
# Builds with sanitizers and runs the tests.
#   tools/sanitize.sh asan|tsan
#   tools/sanitize.sh asan|tsan build     builds them, and runs nothing
# The tests of everything that takes bytes from the network and shares data between threads.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:?which preset: asan or tsan}
# Mesa's shader compiler keeps its caches for the life of the process: not leaks of ours.
export ASAN_OPTIONS=detect_leaks=1:abort_on_error=0
export LSAN_OPTIONS=suppressions=$PWD/tests/lsan.supp:print_suppressions=0
export UBSAN_OPTIONS=print_stacktrace=1
export TSAN_OPTIONS=suppressions=$PWD/tests/tsan.supp:halt_on_error=1
case "$preset" in
  asan | tsan) ;;
  *) echo "sanitize.sh: '$preset' is neither asan nor tsan" >&2; exit 2 ;;
esac
case "${2-}" in
  '' | build) ;;
  *) echo "sanitize.sh: '$2' is not a word it knows; leave it out, or say build" >&2; exit 2 ;;
esac
tools/build.sh "$preset" vantage_thread_tests
[ "${2-}" = build ] && exit
tools/run_ctest.sh "$preset" -L threads
