#!/usr/bin/env bash
# How late this computer sends pulses, beside what cyclictest (package rt-tests) says of its timers: both run at the same
# time, at the same rate and priority, on a pretended line.
#   trigger_lateness.sh [SECONDS] [VANTAGE_RIG]      default: 30 s, build/release/bin/vantage-rig
# Closes with one JSON object: lateness in us, p50, p99 and max of either; cyclictest's are null where it is missing.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
seconds=${1:-30}
rig=${2:-$here/../../build/release/bin/vantage-rig}
rate_hz=100
count=$((seconds * rate_hz))
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cat >"$work/rig.toml" <<END
version = 1
name = "lateness"
[source]
rate_hz = $rate_hz
[trigger]
exposure_us = 2000
late_limit_us = 1000000
END

cyclic=
if command -v cyclictest >/dev/null; then
  # Its histogram goes to 100 ms in steps of a microsecond. Without leave for real-time priority it ends by itself.
  cyclictest -q -m -p 60 -i $((1000000 / rate_hz)) -l "$count" -h 100000 >"$work/cyclictest" 2>"$work/cyclictest.log" &
  cyclic=$!
fi
"$rig" trigger --config "$work/rig.toml" --count "$count" --pretended --json >"$work/pulses" 2>"$work/pulses.log"
cyclictest=null
if [ -n "$cyclic" ] && wait "$cyclic"; then
  cyclictest=$(awk '/^[0-9]/ {n[$1 + 0] = $2; total += $2}
    /^# Max Latencies/ {max = $4 + 0}
    END {
      for (us = 0; us < 100000; ++us) {
        seen += n[us]
        if (p50 == "" && seen >= 0.50 * total) p50 = us
        if (p99 == "" && seen >= 0.99 * total) p99 = us
      }
      printf "{\"p50\": %d, \"p99\": %d, \"max\": %d}", p50, p99, max
    }' "$work/cyclictest")
fi
cat "$work/pulses.log" "$work/cyclictest.log" >&2 2>/dev/null || true
jq -c --argjson cyclictest "$cyclictest" \
  '{rate_hz, sent, skipped, lateness_us, width_error_us, cyclictest_us: $cyclictest}' "$work/pulses"
