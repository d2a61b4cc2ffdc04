#!/usr/bin/env bash
# Plays the demo stage for long, and holds it to account: memory, file descriptors and threads stay bounded, every frame is
# accounted for.
#   tools/soak.sh [SECONDS, default 300] [SEED] [DOCUMENT]
# With a SEED something befalls the stage every ten seconds, drawn at random from it: a rig hangs (SIGSTOP), a rig is killed
# and started anew, the GPU is reset, strangers send garbage, strangers connect and say nothing, a rig's clock is set by 50 ms
# and back, a take begins whose disk is soon full, the host hangs for a second, a rig is taken out of the stage file and put
# back, a rig with a valid key attacks, the host's clock is set by 50 ms and back. Then a Vantage is needed that was built with
# its tests, and oscsend. A DOCUMENT's table is written anew.
# Prints the account of every rig, and closes with a line `N passed, N failed`.
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/demo_stage.sh
seconds=${1:-300} seed=${2-} document=${3-}
case "$seconds" in
  *[!0-9]* | "" | ? | [12]?) echo "soak.sh: '$seconds' is no number of seconds of at least 30" >&2; exit 2 ;;
esac
out=$PWD/out/soak
rm -rf "$out"
mkdir -p "$out"

rigs= host= hostile=
declare -A begun=()  # rigs that were started anew
rig_process() { echo "${begun[$1]:-$(pgrep -P "$rigs" -f "/$1\.toml")}"; }
end_all() {
  for process in $hostile $host ${begun[*]} $rigs; do kill -CONT "$process" 2>/dev/null && kill "$process" || true; done
  rm -rf "${libraries-}"
  wait
}
trap end_all EXIT
trap 'exit 130' INT TERM

reset=$PWD/build/release/lib/vantage_gpu_reset.so clock=$PWD/build/release/lib/vantage_clock_set.so
attacker=$PWD/build/release/bin/hostile_rig
osc=49120 take_kib=70000
if [ -n "$seed" ]; then
  for file in "$reset" "$clock" "$attacker"; do
    [ -e "$file" ] || { echo "soak.sh: $file is missing; ./test builds it" >&2; exit 2; }
  done
  command -v oscsend >/dev/null || { echo "soak.sh: oscsend is missing (sudo apt install liblo-tools)" >&2; exit 2; }
  # The loader parts its list at spaces, which a checkout's path may have.
  libraries=$(mktemp -d)
  ln -s "$reset" "$libraries/reset.so"
  ln -s "$clock" "$libraries/clock.so"
  export CLOCK_SET_MS=50
fi
LD_PRELOAD=${seed:+$libraries/clock.so} start_rigs "$out" "$out"
stage=$out/demo/stage.toml
cp "$stage" "$out/whole.toml"
(
  # A file that may not grow fails a take as a full disk does.
  [ -z "$seed" ] || { trap '' XFSZ; ulimit -f $take_kib; }
  CLOCK_SET_BY_RTMIN=1 LD_PRELOAD=${seed:+"$libraries/reset.so $libraries/clock.so"} exec build/release/bin/vantage live --stage "$stage" --headless --no-jog \
    --past-mb 64 --rate 15 --seconds "$seconds" --path hw_config/moves/demo.toml --takes "$out" --control "osc://127.0.0.1:$osc" \
    --json >"$out/soak.json" 2>"$out/live.log"
) &
host=$!
until grep -qs ' frames, ' "$out/live.log"; do sleep 0.2; kill -0 $host; done
started=$(date +%s)

declare -A times=()
# Gives the running show this stage file.
follow() { # file
  cp "$1" "$stage.new"
  mv "$stage.new" "$stage"
  oscsend 127.0.0.1 $osc /vantage/reload_stage
}
port_of() { sed -n 's/^bind = "tcp:\/\/.*:\([0-9]*\)"$/\1/p' "$out/demo/$1.toml"; }
# Nobody waits for what goes on beside, nor remembers it: once, when numbers of processes had begun to come again, this shell
# hung in its own wait. Whether it took a process for one that it remembered was not found out.
befall() {
  local what=$((RANDOM % 11)) rig=rig$((1 + RANDOM % 4)) length=$((1 + RANDOM % 5)) names
  names=(hangs killed resets garbage silence clocks takes "host hangs" reloads attacks "host clock")
  times[${names[what]}]=$((${times[${names[what]}]:-0} + 1))
  echo "$(($(date +%s) - started)) s: ${names[what]} $rig, $length s" >>"$out/faults.log"
  case $what in
    0) kill -STOP "$(rig_process "$rig")"; (sleep $length; kill -CONT "$(rig_process "$rig")") & disown ;;
    1) kill -CONT "$(rig_process "$rig")" || true
      kill -KILL "$(rig_process "$rig")"
      sleep $length
      LD_PRELOAD=$libraries/clock.so LP_NUM_THREADS=1 build/release/bin/vantage-rig run --config "$out/demo/$rig.toml" >>"$out/$rig.log" 2>&1 &
      begun[$rig]=$! ;;
    2) kill -USR2 $host ;;
    3) (for _ in {1..20}; do head -c 5000 /dev/urandom >"/dev/tcp/127.0.0.1/$(port_of "$rig")" || true; done) 2>/dev/null & disown ;;
    4) (for file in {100..160}; do eval "exec $file<>/dev/tcp/127.0.0.1/$(port_of "$rig")" || true; done; sleep $length) 2>/dev/null & disown ;;
    5) kill -USR1 "$(rig_process "$rig")"; sleep $length; kill -USR2 "$(rig_process "$rig")" ;;
    6) rm -f "$out"/*.mkv; oscsend 127.0.0.1 $osc /vantage/take ;;
    7) kill -STOP $host; sleep 1; kill -CONT $host ;;
    8) awk -v rig="$rig" '/^\[/ { if (!gone) printf "%s", entry; entry = ""; gone = 0 } { entry = entry $0 "\n" }
        $0 ~ "name = ." rig ".$" { gone = 1 } END { if (!gone) printf "%s", entry }' "$out/whole.toml" >"$out/part.toml"
      follow "$out/part.toml"; sleep $length; follow "$out/whole.toml" ;;
    9) "$attacker" "$(sed -n 's/^rate_hz = //p' "$stage")" "$seed" >"$out/hostile.toml" & hostile=$!
      until grep -q public_key "$out/hostile.toml"; do sleep 0.1; done
      cat "$out/whole.toml" "$out/hostile.toml" >"$out/part.toml"
      follow "$out/part.toml"; sleep $length; follow "$out/whole.toml"
      kill $hostile; hostile= ;;
    10) kill -s RTMIN+1 $host; sleep $length; kill -s RTMIN+2 $host ;;
  esac
}

[ -z "$seed" ] || RANDOM=$seed
last=0
while kill -0 $host 2>/dev/null; do
  sleep 2
  now=$(($(date +%s) - started))
  sample "$now" $host $(pgrep -P "$rigs" vantage-rig || true) ${begun[*]} >>"$out/samples"
  # The last rig that was touched is back before the end.
  if [ -n "$seed" ] && [ $((now - last)) -ge 10 ] && [ "$now" -lt $((seconds - 20)) ]; then
    last=$now
    befall 2>>"$out/befall.log"
  fi
done
status=0
wait $host || status=$?
host=
# It ends with the name of a take that failed, as a full disk's has to.
[ $status -eq 0 ] || { [ -n "${times[takes]-}" ] && tail -1 "$out/live.log" | grep -q 'but an output failed'; } || { tail -5 "$out/live.log" >&2; echo "0 passed, 1 failed"; exit 1; }

# A rig that was started anew on the way still fills its pools.
awk -v third=$((seconds / 3)) 'NR == FNR { if ($1 < third) begun[$3] = 1; next } $3 in begun' "$out/samples" "$out/samples" \
  >"$out/settled"
# A hostile rig's own counts are invented.
jq 'del(.rigs[] | select(.name == "hostile"))' "$out/soak.json" >"$out/account.json"
passed=0 failed=0
for result in "$(tools/check_memory.sh "$out/settled" "$seconds" || true)" "$(tools/check_account.sh "$out/account.json" || true)"; do
  sed '$d' <<<"$result"
  read -r p _ f _ <<<"$(tail -n 1 <<<"$result")"
  passed=$((passed + p)) failed=$((failed + f))
done
figure() { jq -r "$1" "$out/account.json"; }
# Ticks go by while the host hangs for a second, and no other.
hung=${times["host hangs"]:-0}
if [ "$(figure .missed_ticks)" -le $((17 * hung + 2)) ]; then
  passed=$((passed + 1)) && echo "ok   $(figure .missed_ticks) ticks were missed; the host hung $hung times"
else
  failed=$((failed + 1)) && echo "FAIL $(figure .missed_ticks) ticks were missed, and the host hung $hung times only"
fi
# The median of memory in each third. Of the second half: the least-squares slope of memory in MiB an hour, the most memory,
# threads and file descriptors.
process_rows() {
  sort -n -k4,4 "$out/samples" | awk -v half=$((seconds / 2)) -v third=$((seconds / 3)) '
    { key = $2 " " $3; part = key " " int($1 / third); resident[part, ++count[part]] = $4
      if ($1 < half) { if ($5 > threads[key]) threads[key] = $5; if ($6 > files[key]) files[key] = $6; next }
      n[key]++; x[key] += $1; y[key] += $4; xx[key] += $1 * $1; xy[key] += $1 * $4
      if ($4 > most[key]) most[key] = $4
      if ($5 > late_threads[key]) late_threads[key] = $5; if ($6 > late_files[key]) late_files[key] = $6 }
    END { for (key in n) { if (n[key] < 10 || !(key in threads)) continue
      slope = (n[key] * xy[key] - x[key] * y[key]) / (n[key] * xx[key] - x[key] * x[key])
      middles = ""
      for (k = 0; k < 3; ++k) {
        part = key " " k
        if (count[part]) middles = middles sprintf("%.0f ", resident[part, int((count[part] + 1) / 2)] / 1024)
      }
      printf "| %s | %s| %.1f | %.1f | %d, %d | %d, %d |\n", key, middles, slope * 3600 / 1024, most[key] / 1024, threads[key], late_threads[key], files[key], late_files[key] } }' | sort
}
table=$(
  echo "| | |"
  echo "| --- | --- |"
  echo "| played | $(figure '.duration_s | round') s, load $(cut -d' ' -f1 /proc/loadavg) at the end |"
  [ -z "$seed" ] || echo "| faults, seed $seed | $(for name in "${!times[@]}"; do printf '%s %s, ' "$name" "${times[$name]}"; done | sed 's/, $//') |"
  echo "| ticks, reprojected, repeated, missed | $(figure '"\(.pictures), \(.reprojected_ticks), \(.repeated_ticks), \(.missed_ticks)"') |"
  echo "| hand-over after the tick: p50, p99, most | $(figure '"\(.tick_late_ms.p50 * 10 | round / 10), \(.tick_late_ms.p99 * 10 | round / 10), \(.tick_late_ms.max | round) ms"') |"
  echo "| exposure to picture: p50, p95, p99 | $(figure '"\(.latency_ms.p50 | round), \(.latency_ms.p95 | round), \(.latency_ms.p99 | round) ms"') |"
  echo "| between two new pictures: p50, p99, most | $(figure '"\(.interval_ms.p50 | round), \(.interval_ms.p99 | round), \(.interval_ms.max | round) ms"') |"
  echo "| frame sets: closed, complete, fused | $(figure '"\(.sets.closed), \(.sets.complete), \(.sets.fused)"') |"
  echo "| resets of the GPU that were survived | $(figure .contexts_lost) |"
  echo "| rigs that were away | $(figure '[.rigs[] | "\(.name) \(.outages.count) times"] | join(", ")') |"
  echo "| frames sent, lost, received | $(figure '"\([.rigs[].link.sent] | add), \([.rigs[].link.lost] | add), \([.rigs[].host.received] | add)"') |"
  echo "| checks | $passed of $((passed + failed)) passed |"
  echo
  echo "| process | memory: median of each third, MiB | MiB per hour in the second half | most, MiB | threads: most in each half | file descriptors: most in each half |"
  echo "| --- | --- | --- | --- | --- | --- |"
  process_rows
)
echo "$table"
if [ -n "$document" ]; then
  awk -v table="$table" '/<!-- measured: begin -->/ {print; print table; skip = 1} /<!-- measured: end -->/ {skip = 0; print ""} !skip' \
    "$document" >"$out/document" && cp "$out/document" "$document"
fi
echo "$passed passed, $failed failed"
[ $failed -eq 0 ] && [ $passed -gt 0 ]
