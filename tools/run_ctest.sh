#!/usr/bin/env bash
# Runs CTest on a built preset and closes with a line `N passed, N failed, N skipped`.
#   tools/run_ctest.sh PRESET [ctest options] [--then ctest options]
# What stands after --then is run when all before it have ended. What failed tests printed is repeated at the end.
set -uo pipefail
cd "$(dirname "$0")/.."
preset=$1
shift
passed=0 failures=0 skipped=0 status=0
# Of its tests GoogleTest tells what failed or was skipped, and how many there were.
export GTEST_BRIEF=1

run() { # ctest options
  local results=build/$preset/results.xml log=build/$preset/results.log own_passed own_failed own_skipped
  rm -f "$results"
  # One more than there are processors: some tests wait for networks and clocks.
  ctest --test-dir "build/$preset" --output-on-failure --no-tests=error -j $(($(nproc) + 1)) --output-junit results.xml \
    --test-output-size-passed 10000000 "$@" |
    grep --line-buffered -vE '^ *(Start +[0-9]+:)|^$' |
    sed -uE 's/ +# GetParam\(\) = .*(Passed|Skipped|\*\*\*[A-Za-z]+)/ \1/; s/ \.{4,}/ .../' | tee "$log"
  [ "${PIPESTATUS[0]}" -eq 0 ] || status=1
  [ -f "$results" ] || exit 1
  read -r own_passed own_failed own_skipped < <(awk -f tools/count_tests.awk "$results")
  passed=$((passed + own_passed)) failures=$((failures + own_failed)) skipped=$((skipped + own_skipped))
  [ "$own_failed" -eq 0 ] || awk -f tools/failed_tests.awk "$log"
  [ "$own_skipped" -eq 0 ] || grep -oE 'SKIPPED: [^&<]*' "$results" | sort | uniq -c | sort -rn | head -8
}

options=()
for word in "$@"; do
  if [ "$word" = --then ]; then
    run "${options[@]}"
    options=()
  else
    options+=("$word")
  fi
done
run "${options[@]}"
echo "$passed passed, $failures failed, $skipped skipped"
[ "$status" -eq 0 ] && [ "$failures" -eq 0 ] && [ $((passed + skipped)) -gt 0 ]
