#!/usr/bin/env bash
# Lets systemd judge the sandbox of every unit of hw_config/systemd and fails where one is more exposed than it may be.
#   tests/systemd/check_exposure.sh FOLDER_OF_UNITS
set -euo pipefail
units=$1
command -v systemd-analyze >/dev/null || { echo "SKIPPED: systemd-analyze is not installed (package systemd)"; exit 0; }

most=20 # tenths, as --threshold takes them
status=0
for unit in "$units"/*.service; do
  name=$(basename "$unit")
  verdict=$(systemd-analyze security --offline=true --no-pager --threshold="$most" "$unit" 2>&1) || {
    echo "$verdict"
    echo "$name is more exposed than $most tenths"
    status=1
  }
  tail -n 1 <<<"$verdict"
done
exit "$status"
