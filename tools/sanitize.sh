#!/usr/bin/env bash
# Builds with sanitizers and runs the tests.
#   tools/sanitize.sh asan|tsan
# asan: the unit tests. tsan: the tests of everything that shares data between threads.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:?which preset: asan or tsan}
# Mesa's shader compiler keeps its caches for the life of the process: not leaks of ours.
export ASAN_OPTIONS=detect_leaks=1:abort_on_error=0
export LSAN_OPTIONS=suppressions=$PWD/tests/lsan.supp:print_suppressions=0
export UBSAN_OPTIONS=print_stacktrace=1
export TSAN_OPTIONS=suppressions=$PWD/tests/tsan.supp:halt_on_error=1
case "$preset" in
  asan) targets=(vantage_unit_tests) select=(-L unit) ;;
  tsan) targets=(vantage_thread_tests) select=(-L threads) ;;
  *) echo "sanitize.sh: '$preset' is neither asan nor tsan" >&2; exit 2 ;;
esac
tools/build.sh "$preset" "${targets[@]}"
tools/run_ctest.sh "$preset" "${select[@]}"
