#!/usr/bin/env bash
# Runs CTest on a built preset and closes with a line `N passed, N failed, N skipped`.
#   tools/run_ctest.sh PRESET [ctest options] [--then ctest options]
# What stands after --then is run when all before it have ended. What failed tests printed is repeated at the end.
set -uo pipefail
cd "$(dirname "$0")/.."
preset=$1
shift
passed=0 failures=0 skipped=0 status=0

attribute() { sed -n "s/.*[[:space:]]$1=\"\([0-9]*\)\".*/\1/p" "$results" | head -1; }

run() { # ctest options
  local results=build/$preset/results.xml log=build/$preset/results.log all failed left
  rm -f "$results"
  # One more than there are processors: some tests wait for networks and clocks.
  ctest --test-dir "build/$preset" --output-on-failure --no-tests=error -j $(($(nproc) + 1)) --output-junit results.xml "$@" |
    grep --line-buffered -vE '^ *(Start +[0-9]+:)|^$' |
    sed -uE 's/ +# GetParam\(\) = .*(Passed|Skipped|\*\*\*[A-Za-z]+)/ \1/; s/ \.{4,}/ .../' | tee "$log"
  [ "${PIPESTATUS[0]}" -eq 0 ] || status=1
  [ -f "$results" ] || exit 1
  all=$(attribute tests) failed=$(attribute failures) left=$(grep -c 'status="notrun"' "$results")
  failures=$((failures + failed)) skipped=$((skipped + left)) passed=$((passed + all - failed - left))
  [ "$failed" -eq 0 ] || awk '/^ *[0-9]+\/[0-9]+ Test +#/ { telling = /\*\*\*/ && !/Skipped/; lines = 0 } telling && ++lines <= 60' "$log"
  [ "$left" -eq 0 ] || grep -oE 'SKIPPED: [^&<]*' "$results" | sort | uniq -c | sort -rn | head -8
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
[ "$status" -eq 0 ] && [ "$failures" -eq 0 ]
