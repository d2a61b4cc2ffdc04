#!/usr/bin/env bash
# Plays the demo stage in a window through all that can befall it, and holds it to account: no tick is lost, every frame is
# accounted for, memory stays bounded.
#   tools/faults.sh [SECONDS, default 600]
# Again and again, in cycles of 100 s at most: a rig is stopped (SIGSTOP) and goes on, another is killed and started anew, the
# window is resized, the synthesiser changed four times, the GPU reset; the film's disk is full from the start. One cycle is
# played without any of it first, to compare with. Needs a Vantage built with its tests, Xvfb and xdotool.
# Closes with a line `N passed, N failed`.
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/demo_stage.sh
seconds=${1:-600}
case "$seconds" in
  *[!0-9]* | "" | ? | 1?) echo "faults.sh: '$seconds' is no number of seconds of at least 20" >&2; exit 2 ;;
esac
cycle=$((seconds < 100 ? seconds : 100))
rate_hz=15
out=$PWD/out/faults
mkdir -p "$out"

screen= rigs= host=
declare -A begun=()  # rigs that were started anew
end_all() {
  for process in $host ${begun[*]} $rigs $screen; do kill -CONT "$process" 2>/dev/null && kill "$process" || true; done
  wait
}
trap end_all EXIT
trap 'exit 130' INT TERM

start_screen 1600x1000 "$out"

rig_process() { echo "${begun[$1]:-$(pgrep -P "$rigs" -f "/$1\.toml")}"; }
said() { echo "$(($(date +%s) - started)) s: $*"; }

# A moment of a cycle, in its hundredths, and what happens then.
befall() {
  case "$1" in
    5) kill -STOP "$(rig_process rig1)"; said "rig1 is stopped" ;;
    15) kill -CONT "$(rig_process rig1)"; said "rig1 goes on" ;;
    25) kill -KILL "$(rig_process rig2)"; said "rig2 is killed" ;;
    35)
      LP_NUM_THREADS=1 nice -n 5 build/release/bin/vantage-rig run --config out/demo/rig2.toml >>"$out/rig2.log" 2>&1 &
      begun[rig2]=$!
      said "rig2 is started anew" ;;
    45) xdotool search --name '^Vantage' windowsize 720 480; said "the window is small" ;;
    50) xdotool search --name '^Vantage' windowsize 1280 800; said "the window is large" ;;
    55 | 62 | 69 | 76) xdotool mousemove 300 200 key F2; said "another synthesiser" ;;
    85) kill -USR2 $host; said "the GPU is reset" ;;
  esac
}

play() { # name, seconds, whether anything befalls it
  local name=$1 length=$2 troubled=$3
  rm -f out/demo/rig?.log
  start_rigs out "$out"
  : >"$out/$name.log"
  local limit=unlimited
  ! $troubled || limit=256  # KiB, for the film
  (
    trap '' XFSZ
    ulimit -f $limit
    LD_PRELOAD=$PWD/build/release/lib/vantage_gpu_reset.so exec build/release/bin/vantage live --stage out/demo/stage.toml \
      --no-jog --past-mb 64 --rate $rate_hz --seconds "$length" --path hw_config/moves/demo.toml --json \
      --record "$out/$name.mkv" --overwrite
  ) >"$out/$name.json" 2>>"$out/$name.log" &
  host=$!
  until grep -q ' frames, ' "$out/$name.log"; do sleep 0.2; kill -0 $host; done
  started=$(date +%s)
  : >"$out/$name.memory"
  local done=0 cycles=0 moment now
  while kill -0 $host 2>/dev/null; do
    now=$(($(date +%s) - started))
    for process in $host $(pgrep -P "$rigs" vantage-rig || true); do
      kib=$(awk '/VmRSS/ {print $2}' "/proc/$process/status" 2>/dev/null) || continue
      [ -z "$kib" ] || echo "$now $(cat "/proc/$process/comm") $process $kib" >>"$out/$name.memory"
    done
    if $troubled && [ $((cycles * cycle)) -lt "$length" ]; then
      for ((moment = done + 1; moment <= (now - cycles * cycle) * 100 / cycle && moment <= 100; ++moment)); do
        befall $moment
        done=$moment
      done
      if [ $done -ge 100 ]; then done=0 cycles=$((cycles + 1)); fi
    fi
    sleep 1
  done
  status=0
  wait $host || status=$?
  host=
  kill "$rigs" ${begun[*]} 2>/dev/null || true
  wait "$rigs" ${begun[*]} 2>/dev/null || true
  begun=() rigs=
}

echo "$cycle s without any of it, to compare with"
play calm "$cycle" false
calm_status=$status
echo "$seconds s with all of it"
play troubled "$seconds" true
troubled_status=$status

passed=0 failed=0
check() { # what must be, and a jq expression that says so of both reports
  if [ "$(jq -s "(.[0]) as \$calm | (.[1]) as \$it | $2" "$out/calm.json" "$out/troubled.json")" = true ]; then
    passed=$((passed + 1))
    echo "ok   $1"
  else
    failed=$((failed + 1))
    echo "FAIL $1"
  fi
}
figure() { jq -r "$2" "$out/$1.json"; }
share='100 * .repeated_ticks / .pictures | . * 10 | round / 10'
check "the calm play ended well ($calm_status), the other with its film's name ($troubled_status)" \
  "$calm_status == 0 and $troubled_status == 1 and ([\$it.outputs[] | select(.failure != \"\")] | length) == 1"
check "$(figure troubled '.pictures') ticks in $(figure troubled '.duration_s | round') s: $(figure troubled .missed_ticks) passed before the programme came to them; handed over $(figure troubled '.tick_late_ms.p99 | round') ms after the tick (99 %), at most $(figure troubled '.tick_late_ms.max | round')" \
  '$it.missed_ticks <= 0.001 * $it.pictures'
check "$(figure troubled "$share") % of the ticks repeated a picture, $(figure calm "$share") % without faults; a reset costs 30 at most" \
  '$it.repeated_ticks / $it.pictures <= $calm.repeated_ticks / $calm.pictures + 0.02 + 30 * $it.contexts_lost / $it.pictures'
check "the GPU was reset $(figure troubled '.contexts_lost') times, and all of it set up anew" \
  "\$it.contexts_lost >= $((seconds / cycle))"
check "two rigs were away and came back: $(figure troubled '[.rigs[] | select(.outages.count > 0) | "\(.name) \(.outages.count) times"] | join(", ")')" \
  '[$it.rigs[] | select(.outages.count > 0) | .name] | sort == ["rig1", "rig2"]'
check "all four rigs are connected at the end" '[$it.rigs[] | select(.state == "connected")] | length == 4'
results=$(tools/check_account.sh "$out/troubled.json" || true)
if [ "$seconds" -ge 90 ]; then results+=$'\n'$(tools/check_memory.sh "$out/troubled.memory" "$seconds" || true); fi
grep -E '^(ok|FAIL)' <<<"$results"
passed=$((passed + $(grep -c '^ok' <<<"$results" || true))) failed=$((failed + $(grep -c '^FAIL' <<<"$results" || true)))

for name in calm troubled; do
  figure $name '"'$name': \(.new_frames_per_second * 10 | round / 10) new frames per second; between two p50 \(.interval_ms.p50 | round), p99 \(.interval_ms.p99 | round), at most \(.interval_ms.max | round) ms; \(.instants.a_second * 10 | round / 10) instants a second"'
done
echo "$passed passed, $failed failed"
[ $failed -eq 0 ] && [ $passed -gt 0 ]
