#!/usr/bin/env bash
# Builds with sanitizers and runs the tests.
#   tools/sanitize.sh asan|tsan
#   tools/sanitize.sh asan|tsan build     builds them, and runs nothing
# asan runs the tests of everything that reads bytes from outside, tsan those of everything that shares data between
# threads.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:?which preset: asan or tsan}
# Mesa's shader compiler keeps its caches for the life of the process: not leaks of ours.
export ASAN_OPTIONS=detect_leaks=1:abort_on_error=0
export LSAN_OPTIONS=suppressions=$PWD/tests/lsan.supp:print_suppressions=0
export UBSAN_OPTIONS=print_stacktrace=1
export TSAN_OPTIONS=suppressions=$PWD/tests/tsan.supp:halt_on_error=1
case "$preset" in
  asan) target=vantage_bytes_tests label=bytes ;;
  tsan) target=vantage_thread_tests label=threads ;;
  *) echo "sanitize.sh: '$preset' is neither asan nor tsan" >&2; exit 2 ;;
esac
case "${2-}" in
  '' | build) ;;
  *) echo "sanitize.sh: '$2' is not a word it knows; leave it out, or say build" >&2; exit 2 ;;
esac
tools/build.sh "$preset" $target
[ "${2-}" = build ] && exit
tools/run_ctest.sh "$preset" -L $label
