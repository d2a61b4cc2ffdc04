#!/usr/bin/env bash
# Plays the demo stage for long, and holds it to account: memory stays bounded, every frame is accounted for.
#   tools/soak.sh [SECONDS, default 300]
# Prints each process' memory along the way, the account of every rig, and closes with a line `N passed, N failed`.
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=${1:-300}
case "$seconds" in
  *[!0-9]* | "" | ? | [12]?) echo "soak.sh: '$seconds' is no number of seconds of at least 30" >&2; exit 2 ;;
esac
mkdir -p out
report=out/soak.json samples=out/soak_memory.txt
: >"$samples"
build/release/bin/vantage demo --folder out --headless --seconds "$seconds" --json >"$report" 2>out/soak.log &
demo=$!
trap 'kill $demo 2>/dev/null || true; wait' EXIT

# One line a process and sample: second, name, process, resident KiB.
started=$SECONDS
while kill -0 $demo 2>/dev/null; do
  sleep 3
  for pid in $demo $(pgrep -P $demo vantage || true); do
    kib=$(awk '/VmRSS/ {print $2}' "/proc/$pid/status" 2>/dev/null) || continue
    [ -n "$kib" ] && echo "$((SECONDS - started)) $(cat "/proc/$pid/comm") $pid $kib" >>"$samples"
  done
  tail -c 200 out/soak.log | tr '\r' '\n' | tail -1
done
wait $demo || { tail -5 out/soak.log >&2; echo "0 passed, 1 failed"; exit 1; }
trap - EXIT

memory=$(tools/check_memory.sh "$samples" "$seconds" || true)
account=$(tools/check_account.sh "$report" || true)
passed=0 failed=0
for result in "$memory" "$account"; do
  sed '$d' <<<"$result"
  read -r p _ f _ <<<"$(tail -n 1 <<<"$result")"
  passed=$((passed + p)) failed=$((failed + f))
done
jq -r '"\(.pictures) pictures in \(.duration_s | round) s; \(.sets.closed) sets: \(.sets.complete) complete, \(.sets.fused) fused, \(.sets.superseded) superseded, \(.sets.dropped) dropped"' "$report"
echo "$passed passed, $failed failed"
[ $failed -eq 0 ] && [ $passed -gt 0 ]
