#!/usr/bin/env bash
# Plays the demo stage: four rigs, each a process of its own, and the host, over authenticated sockets on loopback.
#   tools/demo.sh [--headless] [--seconds N] [--json] [--files LEFT RIGHT]
#                 [--rigs-only]    starts the rigs, says so on stdout and waits to be ended: another host may use them
#                 [--keep FOLDER]  the rigs keep takes of their own there
#                 [--rig CALIB.yaml LEFT RIGHT [--disparities N] [--rate HZ]]
# Keys, configurations and logs go to out/demo/, results to out/.
set -euo pipefail
cd "$(dirname "$0")/.."

headless=false rigs_only=false seconds=12 json=() left= right= calibration= disparities= asked_hz= keep=
while [ $# -gt 0 ]; do
  case "$1" in
    --headless) headless=true; shift ;;
    --rigs-only) rigs_only=true; shift ;;
    --keep) keep=$(realpath -m "$2"); shift 2 ;;
    --seconds) seconds=$2; shift 2 ;;
    --json) json=(--json); shift ;;
    --files) left=$2 right=$3; shift 3 ;;
    --rig) calibration=$2 left=$3 right=$4; shift 4 ;;
    --disparities) disparities=$2; shift 2 ;;
    --rate) asked_hz=$2; shift 2 ;;
    *) echo "demo.sh: '$1' is not an option" >&2; exit 2 ;;
  esac
done
case "$seconds" in '' | *[!0-9]* | 0) echo "demo.sh: --seconds takes a whole number above 0, not '$seconds'" >&2; exit 2 ;; esac
if [ -z "$calibration" ] && [ -n "$disparities$asked_hz" ]; then
  echo "demo.sh: --disparities and --rate go with --rig" >&2
  exit 2
fi
[ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] || headless=true

bin=$PWD/build/release/bin
out=$PWD/out
demo=$out/demo
mkdir -p "$demo"

rigs=()
stop_rigs() {
  [ ${#rigs[@]} -eq 0 ] || kill "${rigs[@]}" 2>/dev/null || true
  wait 2>/dev/null || true
}
trap stop_rigs EXIT
trap 'exit 130' INT TERM

# The processor draws everything where there is no GPU: then the stage runs at a rate that it holds.
if "$bin/vantage-rig" probe --json 2>/dev/null | grep -q '"is_software": *false'; then
  rate_hz=25 fps=50 size=1920x1080 rig_size=960x720 disparities_of_stage=96 latency_budget_ms=200 preset=balanced loop_ahead=false
else
  rate_hz=5 fps=15 size=480x270 rig_size=320x240 disparities_of_stage=32 latency_budget_ms=600 preset=fast loop_ahead=true
  # Four rigs share the processor: one drawing thread each does the same work with less waiting.
  export LP_NUM_THREADS=1
fi

# Every start has keys of its own; the secret halves never leave this folder.
rm -f "$demo"/*.key "$demo"/*.toml
"$bin/vantage" keys new "$demo/host.key" >/dev/null
"$bin/vantage" keys show "$demo/host.key" >"$demo/authorized_hosts"

free_port() { # the first of a range that nobody listens on
  local port
  for port in $(seq "$1" $(($1 + 200))); do
    (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null || { echo "$port"; return; }
  done
  echo "demo.sh: no free port between $1 and $(($1 + 200)) on loopback" >&2
  exit 1
}

rig_config() { # name port [line of its first part], and on stdin the [source] and [virtual_rig] parts
  cat >"$demo/$1.toml" <<END
version = 1
name = "$1"
${3:-}

[stream]
bind = "tcp://127.0.0.1:$2"
key_file = "$1.key"
authorized_hosts = "authorized_hosts"

$(cat)
END
  [ -z "$keep" ] || printf '\n[keep]\nfolder = "%s"\n' "$keep" >>"$demo/$1.toml"
  "$bin/vantage-rig" keys new "$demo/$1.key" >/dev/null
  cat >>"$demo/stage.toml" <<END

[[rigs]]
name = "$1"
endpoint = "tcp://127.0.0.1:$2"
public_key = "$("$bin/vantage-rig" keys show "$demo/$1.key")"
END
}

value() { # the number that the JSON on stdin has under a key
  sed -n "s/.*\"$1\": *\([-+0-9.eE]*\).*/\1/p" | head -n 1
}

files_source() { # rate: the [source] of what was filmed
  printf '[source]\nkind = "files"\nrate_hz = %s\nleft = "%s"\n' "$1" "$left"
  [ "$right" = - ] || printf 'right = "%s"\n' "$right"
}

# The first pair of a real rig says how large, how fast and how far away what it filmed is.
look_at_rig() {
  rm -rf "$demo/first"
  { printf 'version = 1\nname = "pair"\n'; files_source 30; } >"$demo/look.toml"
  local seen rectified matched first material_hz
  seen=$("$bin/vantage-rig" capture --config "$demo/look.toml" --every 1 --count 1 -o "$demo/first" --json \
    2>"$demo/look.log") || { cat "$demo/look.log" >&2; exit 1; }
  rm "$demo/look.toml"
  first=$(ls "$demo/first"/left_*.png)
  rectified=$("$bin/vantage-calib" rectify --calibration "$calibration" "$first" "${first/left_/right_}" \
    --out-left "$demo/first/left.png" --out-right "$demo/first/right.png" --json)
  if [ -z "$disparities" ]; then
    disparities=$(awk -v width="$(value width <<<"$rectified")" \
      'BEGIN { n = 32 * int((width / 4 + 31) / 32); print (n < 64 ? 64 : n > 256 ? 256 : n) }')
  fi
  matched=$("$bin/vantage-rig" match "$demo/first/left.png" "$demo/first/right.png" --disparities "$disparities" \
    --preset "$preset" --repeats 3 -o "$demo/first/disparity.pfm" --json)
  material_hz=$(value material_rate_hz <<<"$seen")
  # Half of the time is the matcher's; a processor that draws everything shares it with the host.
  rate_hz=${asked_hz:-$(awk -v gpu_ms="$(value gpu_ms <<<"$matched")" -v own="${material_hz:-30}" -v slow="$preset" \
    'BEGIN { most = (slow == "fast" ? 250 : 500) / gpu_ms
             printf "%.4g", (most >= own ? own : most < 0.2 ? 0.2 : most) }')}
  latency_budget_ms=$(awk -v hz="$rate_hz" 'BEGIN { printf "%d", (hz < 15 ? 3000 / hz : 200) }')
  # The flight begins where the left camera stands, about the middle of what it sees.
  awk -v d="$(value median_disparity_px <<<"$matched")" -v doffs="$(value doffs_px <<<"$rectified")" \
    -v f="$(value f_px <<<"$rectified")" -v width="$(value width <<<"$rectified")" \
    -v baseline="$(value baseline_m <<<"$rectified")" -v rectified="$rectified" '
    function vector(key, v,  text) {
      match(rectified, "\"" key "\": *\\[[^]]*"); text = substr(rectified, RSTART, RLENGTH)
      sub(/.*\[/, "", text); split(text, v, ",") }
    function keyframe(time, a, e, near) {
      printf "\n[[keyframe]]\ntime_s = %d\nazimuth_deg = %.3f\nelevation_deg = %.3f\n", time, azimuth + a, elevation + e
      printf "distance_m = %.4f\n", near * depth
      if (time == 0)
        printf "pivot_m = [%.4f, %.4f, %.4f]\nfield_of_view_deg = %.2f\n", p[1] + depth * l[1], p[2] + depth * l[2],
          p[3] + depth * l[3], 2 * atan2(width / 2, f) * degrees }
    BEGIN {
      degrees = 45 / atan2(1, 1); depth = f * baseline / (d + doffs)
      vector("position_m", p); vector("looks_along", l)
      azimuth = atan2(-l[1], -l[3]) * degrees; elevation = atan2(-l[2], sqrt(l[1] ^ 2 + l[3] ^ 2)) * degrees
      print "version = 1\nloop = false"
      # A single rig shows its scene from one side only: the flight stays within some baselines of it.
      aside = atan2(3 * baseline, depth) * degrees; if (aside > 4) aside = 4
      near = 3 * baseline / depth; if (near > 0.15) near = 0.15
      keyframe(0, 0, 0, 1); keyframe(3, aside, aside / 4, 1 - near / 2); keyframe(6, 0, aside / 2, 1 - near)
      keyframe(9, -aside, aside / 4, 1 - near / 2)
      keyframe(12, 0, 0, 1) }' >"$demo/pair_move.toml"
  echo "demo: searched for $disparities disparities; played at $rate_hz Hz${material_hz:+ of its own $material_hz}" >&2
}
[ -z "$calibration" ] || look_at_rig

width=${size%x*} height=${size#*x}
cat >"$demo/stage.toml" <<END
version = 1
rate_hz = $rate_hz
key_file = "host.key"
latency_budget_ms = $latency_budget_ms

[view]
width_px = $width
height_px = $height
END

# Two demos at a time begin to look for free ports at different places.
port=$((20000 + $$ % 2000 * 10))
if [ -z "$left" ]; then
  move=hw_config/moves/demo.toml
  i=0
  for azimuth in -30 -10 10 30; do
    i=$((i + 1))
    port=$(free_port $((port + 1)))
    rig_config "rig$i" "$port" <<END
[source]
kind = "virtual"
rate_hz = $rate_hz
width_px = ${rig_size%x*}
height_px = ${rig_size#*x}
noise_sigma = 1.0
seed = $i

[virtual_rig]
azimuth_deg = $azimuth
loop_ahead = $loop_ahead

[match]
preset = "$preset"
disparities = $disparities_of_stage
END
  done
elif [ -n "$calibration" ]; then
  move=$demo/pair_move.toml
  port=$(free_port $((port + 1)))
  rig_config pair "$port" "calibration = \"$calibration\"" <<END
$(files_source "$rate_hz")

[match]
preset = "$preset"
disparities = $disparities
END
else
  move=hw_config/moves/pair.toml
  port=$(free_port $((port + 1)))
  # A bare pair says nothing of its cameras: they are taken to see 30 degrees, with the baseline that puts the
  # middle of the scene 2 m away.
  report=$("$bin/vantage-rig" match "$left" "$right" --disparities 128 -o "$demo/pair.pfm" --json)
  baseline_m=$(awk -v report="$report" 'function value(key) {
      match(report, "\"" key "\": *[0-9.]+")
      text = substr(report, RSTART, RLENGTH); sub(/.*: */, "", text); return text }
    BEGIN { f = value("width") / 2 / 0.267949; printf "%.5f", 2.0 * value("median_disparity_px") / f }')
  rig_config pair "$port" <<END
[source]
kind = "files"
rate_hz = $rate_hz
left = "$left"
right = "$right"

[virtual_rig]
elevation_deg = 0.0
distance_m = 2.0
field_of_view_deg = 30.0
baseline_m = $baseline_m

[match]
disparities = 128
END
fi

for config in "$demo"/rig*.toml "$demo"/pair.toml; do
  [ -f "$config" ] || continue
  name=$(basename "$config" .toml)
  # What stands for rig computers yields to the host, which has this one for itself elsewhere.
  nice -n 5 "$bin/vantage-rig" run --config "$config" >"$demo/$name.log" 2>&1 &
  rigs+=($!)
done
echo "demo: ${#rigs[@]} rig(s) started at $rate_hz pulses a second; their logs are in out/demo/" >&2
if [ -z "$left$calibration" ] && $loop_ahead; then
  echo "demo: the rigs draw the stage's loop of 24 s before they begin, a few seconds' work" >&2
fi

if $rigs_only; then
  echo "ready: $demo/stage.toml"
  wait
  exit
fi

# A processor that draws everything also compiles the programs first; a slow one takes its time.
live=(live --stage "$demo/stage.toml" --wait 60 --rate "$fps")
host=(env -u LP_NUM_THREADS "$bin/vantage")
if $headless; then
  # Nobody goes back in time here.
  "${host[@]}" "${live[@]}" --headless --past-mb 64 --seconds "$seconds" "${json[@]}" --path "$move" \
    --record "$out/flight.mkv" --overwrite --contact-sheet "$out/contact_sheet.png" --snapshot "$out/last_view.png"
  [ ${#json[@]} -gt 0 ] || printf '\nThe flight:        out/flight.mkv\nIts contact sheet: out/contact_sheet.png\n'
elif [ -n "$calibration" ]; then
  # The host begins where the rig stands.
  "${host[@]}" "${live[@]}" --takes "$out" --flight "$out/flight-rig.toml"
else
  "${host[@]}" "${live[@]}" --takes "$out" --path "$move" --flight "$out/flight-${move##*/}"
fi
