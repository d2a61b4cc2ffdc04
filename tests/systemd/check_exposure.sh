#!/usr/bin/env bash
# Lets systemd judge the sandbox of every unit of hw_config/systemd, those of a person's own manager included, and fails
# where one is more exposed than it may be.
#   tests/systemd/check_exposure.sh FOLDER_OF_UNITS
set -euo pipefail
units=$1
command -v systemd-analyze >/dev/null || { echo "SKIPPED: systemd-analyze is not installed (package systemd)"; exit 0; }

most=20 # tenths, as --threshold takes them
status=0
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for unit in "$units"/*.service "$units"/user/*.service; do
  [ -e "$unit" ] || continue
  name=$(basename "$unit")
  # Only such a manager knows that it does not run as root.
  if [ "$(basename "$(dirname "$unit")")" = user ]; then
    sed 's/^\[Service\]$/&\nUser=somebody/' "$unit" >"$work/$name"
    unit=$work/$name
  fi
  verdict=$(systemd-analyze security --offline=true --no-pager --threshold="$most" "$unit" 2>&1) || {
    echo "$verdict"
    echo "$name is more exposed than $most tenths"
    status=1
  }
  tail -n 1 <<<"$verdict"
done
exit "$status"
