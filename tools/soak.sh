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
tools/demo.sh --headless --seconds "$seconds" --json >"$report" 2>out/soak.log &
demo=$!
trap 'kill $demo 2>/dev/null || true; wait' EXIT

# One line a process and sample: second, name, process, resident KiB.
started=$SECONDS
while kill -0 $demo 2>/dev/null; do
  sleep 3
  for pid in $(pgrep -P $demo vantage || true); do
    kib=$(awk '/VmRSS/ {print $2}' "/proc/$pid/status" 2>/dev/null) || continue
    [ -n "$kib" ] && echo "$((SECONDS - started)) $(cat "/proc/$pid/comm") $pid $kib" >>"$samples"
  done
  tail -c 200 out/soak.log | tr '\r' '\n' | tail -1
done
wait $demo || { tail -5 out/soak.log >&2; echo "0 passed, 1 failed"; exit 1; }
trap - EXIT

passed=0 failed=0
check() { # what it must be, status
  if [ "$2" -eq 0 ]; then passed=$((passed + 1)); else failed=$((failed + 1)); fi
  printf '%-4s %s\n' "$([ "$2" -eq 0 ] && echo ok || echo FAIL)" "$1"
}

# Memory: the last third must not lie above the second; the first is for filling pools and caches.
while read -r name pid second third; do
  status=0
  [ "$third" -le $((second + second / 50 + 1024)) ] || status=1
  check "$name $pid: resident $((second / 1024)) MiB at most in the second third, $((third / 1024)) MiB in the last" $status
done < <(awk -v length_s="$seconds" '
  { third = int(3 * $1 / length_s); key = $2 " " $3; if ($4 > most[key, third]) most[key, third] = $4; seen[key] = 1 }
  END { for (key in seen) if (most[key, 1] && most[key, 2]) print key, most[key, 1], most[key, 2] }' "$samples" | sort)

account=$(tools/check_account.sh "$report" || true)
sed '$d' <<<"$account"
read -r p _ f _ <<<"$(tail -n 1 <<<"$account")"
passed=$((passed + p)) failed=$((failed + f))
jq -r '"\(.pictures) pictures in \(.duration_s | round) s; \(.sets.closed) sets: \(.sets.complete) complete, \(.sets.fused) fused, \(.sets.superseded) superseded, \(.sets.dropped) dropped"' "$report"
echo "$passed passed, $failed failed"
[ $failed -eq 0 ] && [ $passed -gt 0 ]
