#!/usr/bin/env bash
# Plays the demo stage: four rigs, each a process of its own, and the host, over authenticated sockets on loopback.
#   tools/demo.sh [--headless] [--seconds N] [--json] [--files LEFT RIGHT]
# Keys, configurations and logs go to out/demo/, results to out/.
set -euo pipefail
cd "$(dirname "$0")/.."

headless=false seconds=12 json=() left= right=
while [ $# -gt 0 ]; do
  case "$1" in
    --headless) headless=true; shift ;;
    --seconds) seconds=$2; shift 2 ;;
    --json) json=(--json); shift ;;
    --files) left=$2 right=$3; shift 3 ;;
    *) echo "demo.sh: '$1' is not an option" >&2; exit 2 ;;
  esac
done
case "$seconds" in '' | *[!0-9]* | 0) echo "demo.sh: --seconds takes a whole number above 0, not '$seconds'" >&2; exit 2 ;; esac
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
  rate_hz=30 fps=30 size=1280x720 latency_budget_ms=200
else
  rate_hz=2 fps=4 size=480x270 latency_budget_ms=1500
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

rig_config() { # name port, and on stdin the [source] and [virtual_rig] parts
  cat >"$demo/$1.toml" <<END
version = 1
name = "$1"

[stream]
bind = "tcp://127.0.0.1:$2"
key_file = "$1.key"
authorized_hosts = "authorized_hosts"

$(cat)
END
  "$bin/vantage-rig" keys new "$demo/$1.key" >/dev/null
  cat >>"$demo/stage.toml" <<END

[[rigs]]
name = "$1"
endpoint = "tcp://127.0.0.1:$2"
public_key = "$("$bin/vantage-rig" keys show "$demo/$1.key")"
END
}

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

port=5600
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
width_px = 320
height_px = 240
noise_sigma = 1.0
seed = $i

[virtual_rig]
azimuth_deg = $azimuth

[match]
disparities = 32
END
  done
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
  "$bin/vantage-rig" run --config "$config" >"$demo/$name.log" 2>&1 &
  rigs+=($!)
done
echo "demo: ${#rigs[@]} rig(s) started at $rate_hz pulses a second; their logs are in out/demo/" >&2

# A processor that draws everything also compiles the programs first; a slow one takes its time.
live=(live --stage "$demo/stage.toml" --wait 60)
host=(env -u LP_NUM_THREADS "$bin/vantage")
if $headless; then
  # Nobody goes back in time here.
  "${host[@]}" "${live[@]}" --headless --past-mb 64 --rate "$fps" --seconds "$seconds" "${json[@]}" --path "$move" \
    --record "$out/flight.mkv" --contact-sheet "$out/contact_sheet.png" --snapshot "$out/last_view.png"
  [ ${#json[@]} -gt 0 ] || printf '\nThe flight:        out/flight.mkv\nIts contact sheet: out/contact_sheet.png\n'
else
  "${host[@]}" "${live[@]}" --path "$move"
fi
