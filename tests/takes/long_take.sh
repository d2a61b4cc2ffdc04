#!/usr/bin/env bash
# Records a take of the demo's four rigs, kills one of them on the way and starts it again, has the host hang for five
# seconds, and holds the take against what another host of the rigs noted, frame by frame. Then what the take lacks is
# fetched from the rigs' own takes, while the stage goes on, and joined to it.
#   tests/takes/long_take.sh [SECONDS, default 600]
# Everything goes to out/long_take/; closes with a line `N passed, N failed`.
set -euo pipefail
cd "$(dirname "$0")/../.."
seconds=${1:-600}
case "$seconds" in
  *[!0-9]* | "" | ? ) echo "long_take.sh: '$seconds' is no number of seconds of at least 10" >&2; exit 2 ;;
esac
bin=build/release/bin out=out/long_take
rm -rf "$out"
mkdir -p "$out"
children=()
end_all() {
  kill "${children[@]}" 2>/dev/null || true
  wait 2>/dev/null || true
}
trap end_all EXIT

build/release/bin/vantage demo --folder out --rigs-only --keep "$out/kept" >"$out/demo.out" 2>"$out/demo.log" &
demo=$!
children+=("$demo")
until grep -q '^ready' "$out/demo.out"; do
  kill -0 "$demo" || { cat "$out/demo.log" >&2; exit 1; }
  sleep 0.2
done
stage=out/demo/stage.toml
build/release/bin/take_tap note --stage "$stage" -o "$out/notes.txt" 2>"$out/tap.log" &
tap=$!
children+=("$tap")
# The programme costs little: the rigs have the processor.
$bin/vantage live --stage "$stage" --headless --wait 300 --size 160x90 --synth mesh --rate 5 --frames $((5 * seconds)) \
  --take "$out/take.mkv" --json >"$out/live.json" 2>"$out/live.log" &
live=$!
children+=("$live")

until [ -s "$out/take.mkv" ]; do
  kill -0 "$live" || { tail -3 "$out/live.log" >&2; exit 1; }
  sleep 0.2
done
sleep $((seconds / 3))
kill -9 "$(pgrep -P "$demo" -f 'rig2\.toml')"
sleep $((seconds / 20 + 2))
$bin/vantage-rig run --config out/demo/rig2.toml >"$out/rig2_again.log" 2>&1 &
children+=($!)
sleep $((seconds / 20 + 2))
kill -STOP "$live"
sleep 5
kill -CONT "$live"
wait "$live" || true
kill -TERM "$tap"
wait "$tap" || true

passed=0 failed=0
judge() { # what, and a command that has to succeed
  local what=$1
  shift
  if "$@"; then passed=$((passed + 1)); echo "ok      $what"; else failed=$((failed + 1)); echo "FAILED  $what"; fi
}
quietly() { # name, and a command whose output goes to files of that name
  local name=$1
  shift
  "$@" >"$out/$name.json" 2>"$out/$name.log"
}
judge "the take was recorded to its end" test "$(jq -r .take.state "$out/live.json")" = ended
judge "the programme was over after its time" test "$(jq -r .pictures "$out/live.json")" -ge $((5 * seconds))
judge "what was noted is in the take byte for byte" $bin/take_tap compare "$out/take.mkv" "$out/notes.txt"
$bin/vantage take check "$out/take.mkv" --json >"$out/check.json" 2>/dev/null || true
echo "check: $(jq -r '"\(.frames) frames, \(.missing) pulses missing in \(.gaps | length) gaps, \(.damage | length) damaged places"' "$out/check.json")"
judge "nothing in the take is damaged" test "$(jq '.damage | length' "$out/check.json")" -eq 0
judge "check names the rig that was killed" quietly named jq -e '[.gaps[] | select(.rig == "rig2") | .why | select(test("anew"))] | length >= 1' \
  "$out/check.json"
judge "what the take lacks is fetched" quietly fetch $bin/vantage rigs fetch --stage "$stage" --gaps-of "$out/take.mkv" \
  -o "$out/fetched" --wait 60 --json
jq -r '.rigs[] | "\(.name): \(.frames) frames fetched, \(.not_kept) pulses that the rig has not kept either"' "$out/fetch.json"
judge "of all rigs, which filmed while the host hung" test "$(jq '[.rigs[] | select(.frames > 0)] | length' "$out/fetch.json")" -eq 4
judge "and joined" quietly join $bin/vantage take join "$out/take.mkv" "$out"/fetched/*.mkv -o "$out/whole.mkv" --json
$bin/vantage take check "$out/whole.mkv" --json >"$out/check_whole.json" 2>/dev/null || true
echo "check of the whole: $(jq -r '"\(.frames) frames, \(.missing) pulses missing in \(.gaps | length) gaps"' "$out/check_whole.json")"
judge "only what no rig kept is missing then" test "$(jq .missing "$out/check_whole.json")" -le \
  "$(jq '[.rigs[].not_kept] | add' "$out/fetch.json")"
judge "all that was noted is in the whole byte for byte" $bin/take_tap compare "$out/whole.mkv" "$out/notes.txt" --all
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
