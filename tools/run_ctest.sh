#!/usr/bin/env bash
# Runs CTest on a built preset and closes with a line `N passed, N failed, N skipped`.
#   tools/run_ctest.sh PRESET [ctest options]
set -uo pipefail
cd "$(dirname "$0")/.."
preset=$1
shift
results=build/$preset/results.xml
rm -f "$results"
ctest --test-dir "build/$preset" --output-on-failure --no-tests=error -j "$(nproc)" \
  --output-junit results.xml "$@" |
  grep --line-buffered -vE '^ *(Start +[0-9]+:)|^$' |
  sed -uE 's/ +# GetParam\(\) = .*(Passed|Skipped|\*\*\*[A-Za-z]+)/ \1/; s/ \.{4,}/ .../'
status=${PIPESTATUS[0]}
[ -f "$results" ] || exit 1

attribute() { sed -n "s/.*[[:space:]]$1=\"\([0-9]*\)\".*/\1/p" "$results" | head -1; }
tests=$(attribute tests) failures=$(attribute failures)
skipped=$(grep -c 'status="notrun"' "$results")
passed=$((tests - failures - skipped))
if [ "$skipped" -gt 0 ]; then
  grep -oE 'SKIPPED: [^&<]*' "$results" | sort | uniq -c | sort -rn | head -8
fi
echo "$passed passed, $failures failed, $skipped skipped"
[ "$status" -eq 0 ] && [ "${failures:-1}" -eq 0 ]
