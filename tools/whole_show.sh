#!/usr/bin/env bash
# Plays the demo stage in a window with everything at once, and holds it to account: memory, threads and files stay bounded,
# outputs stay on, every frame is accounted for.
#   tools/whole_show.sh [SECONDS, default 1800] [TRACE]
# On air: a film in segments, SRT with a receiver, UDP, a pipe that ffmpeg reads, the camera as FreeD, time code as sound; with
# sound from a file. A take runs, is ended and begun again. Operators over OSC, RossTalk, TSL and the keyboard fly, mark, freeze,
# play clips and a list, fly and cut a preview, go back to live; Prometheus asks. Needs a built Vantage, Xvfb, xdotool, oscsend,
# srt-live-transmit, ffmpeg, curl and jq. TRACE is a file for the trace of the host (tools/trace.py). Closes with a line `N passed, N failed`.
set -euo pipefail
cd "$(dirname "$0")/.."
. tools/demo_stage.sh
seconds=${1:-1800} trace=${2:-}
# A round of all that operators do takes a minute, and every third of the time is to have one.
[[ $seconds =~ ^[0-9]+$ ]] && [ "$seconds" -ge 180 ] || {
  echo "whole_show.sh: '$seconds' is no number of seconds of at least 180" >&2
  exit 2
}
for tool in Xvfb xdotool oscsend srt-live-transmit ffmpeg curl jq; do
  command -v "$tool" >/dev/null || { echo "whole_show.sh: $tool is missing" >&2; exit 2; }
done
out=$PWD/out/whole_show
rm -rf "$out"
mkdir -p "$out"

screen= rigs= host= receiver=
end_all() {
  for process in $host $rigs $receiver $screen; do kill "$process" 2>/dev/null || true; done
  wait
}
trap end_all EXIT
trap 'exit 130' INT TERM

start_screen 1280x720 "$out"
ffmpeg -v error -f lavfi -i sine=frequency=440:duration=10 "$out/music.wav"
start_rigs "$out" "$out"
osc=49100 panel=49101 mixer=49102 tracker=49103 metrics=49104 srt=49105 udp=49106 camera=49107
mkfifo "$out/pipe"
ffmpeg -v error -i "$out/pipe" -f null - 2>"$out/pipe.log" &
build/release/bin/vantage live --stage "$out/demo/stage.toml" --past-mb 24 --rate 25 --seconds "$seconds" \
  --path hw_config/moves/demo.toml --audio "file:$out/music.wav?loop=yes" --takes "$out" --json --overwrite \
  --output "$out/film.mkv?segment=60s" --output "srt://127.0.0.1:$srt?mode=listener" --output "udp://127.0.0.1:$udp" \
  --output 'pipe:5?format=y4m' --output "ltc:$out/code.wav" --output "freed://127.0.0.1:$camera" \
  --control "osc://:$osc" --control "rosstalk://:$panel" --control "tsl://:$mixer?address=5" --control "freed://:$tracker" \
  ${trace:+--trace "$trace"} --metrics "http://:$metrics" >"$out/show.json" 2>"$out/live.log" 5>"$out/pipe" &
host=$!
until grep -qs ' frames, ' "$out/live.log"; do
  sleep 0.2
  kill -0 $host 2>/dev/null || { tail -2 "$out/live.log" >&2; echo "0 passed, 1 failed"; exit 1; }
done
started=$(date +%s)
srt-live-transmit -q "srt://127.0.0.1:$srt?mode=caller" file://con >/dev/null 2>"$out/srt.log" &
receiver=$!

# An act that hangs would hold up all that come after it and the samples.
ask() { timeout 5 oscsend 127.0.0.1 $osc "/vantage/$1" "${@:2}"; }
press() { timeout 5 bash -c "printf '%s\r\n' '$1' >/dev/tcp/127.0.0.1/$panel"; }
tally() { printf '\x85%b%-16s' "$1" VIRT1 >"/dev/udp/127.0.0.1/$mixer"; }
key() { timeout 5 xdotool mousemove 300 200 key --delay 50 "$@"; }
# A round of a minute, by its second: what an operator does.
act() {
  case $1 in
    2) tally '\x01'; key 1 ;;
    6) press 'GPI 3' ;;
    10) press 'GPI 4'; press 'GPI 5' ;;
    12) tally '\x02'; ask freeze; ask orbit f 15 ;;
    16) ask orbit f -15; ask clip_speed i 50 ;;
    18) press 'GPI 7'; ask add_entry ;;
    26) press 'GPI 9'; key ctrl+Tab ;;
    32) press 'GPI 1'; key ctrl+Tab slash ;;
    34) ask orbit f 20 ;;
    38) ask cut; key ctrl+shift+Tab ;;
    42) ask auto; key F1 ;;
    46) ask preview; key F1 ctrl+shift+Tab ;;
    48) ask remove_entry; ask remove_entry; ask delete_clip; ask delete_clip ;;
    50) ask take; curl -s --max-time 5 "http://127.0.0.1:$metrics/metrics" >"$out/metrics.txt" || true ;;
    52) ask play ;;
    54) ask take; tally '\0' ;;
  esac
}
ask take
last=-1
while kill -0 $host 2>/dev/null; do
  sleep 1
  now=$(($(date +%s) - started))
  while [ $last -lt $now ]; do
    last=$((last + 1))
    [ $last -gt $((seconds - 8)) ] || act $((last % 60)) || echo "an act of second $last failed" >&2
  done 2>>"$out/acts.log"
  sample "$now" $host $(pgrep -P "$rigs" vantage-rig || true) >>"$out/samples"
done
status=0
wait $host || status=$?
host=
[ $status -eq 0 ] || { tail -5 "$out/live.log" >&2; echo "0 passed, 1 failed"; exit 1; }

passed=0 failed=0
for result in "$(tools/check_memory.sh "$out/samples" "$seconds" || true)" "$(tools/check_account.sh "$out/show.json" || true)"; do
  sed '$d' <<<"$result"
  read -r p _ f _ <<<"$(tail -n 1 <<<"$result")"
  passed=$((passed + p)) failed=$((failed + f))
done
holds() { # sentence, jq expression
  if [ "$(jq -r "$2" "$out/show.json")" = true ]; then
    passed=$((passed + 1)) && echo "ok   $1"
  else
    failed=$((failed + 1)) && echo "FAIL $1"
  fi
}
holds "no output failed" '[.outputs[] | select(.failure != "" and .failure != null)] == []'
holds "every tick went to the film or was counted" '.pictures as $ticks | .outputs[0] | .pictures + .dropped == $ticks'
holds "what was asked was known" '[.control[] | .malformed + .unknown] | add == 0'
holds "every port was heard, but the tracker's" '[.control[] | select(.obeyed == 0)] | length <= 1'
jq -r '"ticks \(.pictures), reprojected \(.reprojected_ticks), repeated \(.repeated_ticks), missed \(.missed_ticks); input to picture p50 \(.input_to_picture_ms.p50 | round) ms, p99 \(.input_to_picture_ms.p99 | round) ms"' "$out/show.json"
echo "$passed passed, $failed failed"
[ $failed -eq 0 ] && [ $passed -gt 0 ]
