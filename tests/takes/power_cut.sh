#!/usr/bin/env bash
# Records a take of the demo's four rigs on a small disk (ext4) of its own, takes images of that disk at random moments,
# which are what power cuts would leave of it, and holds the take on each image against the one that was ended in order.
#   tests/takes/power_cut.sh [CUTS, default 20]
# As root, with loop devices and xfsprogs: XFS copies an image of a disk at one moment. Everything goes to out/power_cut/;
# closes with a line `N passed, N failed`.
set -euo pipefail
# What is mounted is nobody else's, and goes with this process.
[ -n "${HAS_OWN_MOUNTS:-}" ] || exec env HAS_OWN_MOUNTS=1 unshare --mount "$0" "$@"
cd "$(dirname "$0")/../.."
cuts=${1:-20}
case "$cuts" in
  *[!0-9]* | "" | 0) echo "power_cut.sh: '$cuts' is no number of cuts" >&2; exit 2 ;;
esac
[ "$(id -u)" -eq 0 ] && command -v mkfs.xfs >/dev/null || { echo "power_cut.sh: it has to be root, and xfsprogs be there" >&2; exit 2; }
vantage=$PWD/build/release/bin/vantage out=$PWD/out/power_cut
rm -rf "$out"
mkdir -p "$out"/{store,disk,cut}
children=()
end_all() {
  kill "${children[@]}" 2>/dev/null || true
  wait 2>/dev/null || true
  for place in cut disk store; do umount "$out/$place" 2>/dev/null || true; done
}
trap end_all EXIT
truncate -s 3G "$out/store.img"
mkfs.xfs -q -m reflink=1 "$out/store.img"
mount -o loop "$out/store.img" "$out/store"
truncate -s 1G "$out/store/disk.img"
mkfs.ext4 -q "$out/store/disk.img"
mount -o loop "$out/store/disk.img" "$out/disk"

"$vantage" demo --folder "$out" --rigs-only >"$out/demo.out" 2>"$out/demo.log" &
children+=("$!")
until grep -q '^ready' "$out/demo.out"; do
  kill -0 "${children[0]}" || { cat "$out/demo.log" >&2; exit 1; }
  sleep 0.2
done
"$vantage" live --stage "$out/demo/stage.toml" --headless --wait 300 --size 160x90 --synth mesh --rate 5 --frames 1000000 \
  --take "$out/disk/take.mkv" --json >"$out/live.json" 2>"$out/live.log" &
live=$!
children+=("$live")
until [ -s "$out/disk/take.mkv" ]; do
  kill -0 "$live" || { tail -3 "$out/live.log" >&2; exit 1; }
  sleep 0.1
done
for cut in $(seq "$cuts"); do
  sleep "$((RANDOM % 3)).$((RANDOM % 10))"
  cp --reflink=always "$out/store/disk.img" "$out/store/$cut.img"
  date +%s%N >"$out/$cut.time"
done
kill -TERM "$live"
wait "$live" || true

# Every frame's record, which has the checksums of its pictures, with the number of its rig.
records() { # take
  for rig in 0 1 2 3; do
    ffmpeg -v quiet -i "$1" -map "0:s:$rig" -f srt - | sed -n "s/^{/{\"rig\":$rig,/p"
  done
}
cp "$out/disk/take.mkv" "$out/whole.mkv"
ffmpeg -v quiet -dump_attachment:t:0 "$out/take.json" -i "$out/whole.mkv" || true
tai_offset_s=$(jq .tai_offset_s "$out/take.json")
records "$out/whole.mkv" | sort >"$out/whole.txt"
passed=0 failed=0
for cut in $(seq "$cuts"); do
  umount "$out/cut" 2>/dev/null || true
  mount -o loop "$out/store/$cut.img" "$out/cut"
  why=
  "$vantage" take check "$out/cut/take.mkv" --json >"$out/check.json" 2>/dev/null || true
  if ! damage=$(jq -r '.damage[] | .what' "$out/check.json") || [ ! -s "$out/check.json" ]; then
    why="the take does not open"
  else
    [ -z "$(grep -v 'are truncated' <<<"$damage")" ] || why="damaged: $damage"
    records "$out/cut/take.mkv" | sort >"$out/cut.txt"
    [ -z "$(comm -23 "$out/cut.txt" "$out/whole.txt")" ] || why="frames are not those of the whole take"
    # What had come by then and is not there; the clock was read when the image was whole.
    lost_ms=$(comm -13 "$out/cut.txt" "$out/whole.txt" | jq -s --argjson at "$(cat "$out/$cut.time")" --argjson tai "${tai_offset_s}e9" \
      '[.[].arrival_tai_ns | $at + $tai - .] | max | if . and . > 0 then . / 1e6 | round else 0 end')
    [ "$lost_ms" -le 1000 ] || why="$lost_ms ms are lost"
    echo "cut $cut: $(wc -l <"$out/cut.txt") frames, $lost_ms ms lost"
    echo "$lost_ms" >>"$out/lost.txt"
  fi
  if [ -z "$why" ]; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "FAILED  cut $cut: $why"; fi
done
[ ! -s "$out/lost.txt" ] || sort -n "$out/lost.txt" | awk '{ all[NR] = $1 } END { print "lost: median " all[int((NR + 1) / 2)] " ms, most " all[NR] " ms" }'
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
