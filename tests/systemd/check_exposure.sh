#!/usr/bin/env bash
# Lets systemd judge the sandbox of every unit of hw_config/systemd, those of the host and of a user's own manager included,
# and fails if a unit is more exposed than it may be.
#   tests/systemd/check_exposure.sh FOLDER_OF_UNITS
set -euo pipefail
units=$1
command -v systemd-analyze >/dev/null || { echo "SKIPPED: systemd-analyze is not installed (package systemd)"; exit 0; }

most=20      # tenths, as --threshold takes them
most_host=23 # PTP of the host runs as root, with a few of its rights
status=0
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for unit in "$units"/*.service "$units"/host/*.service "$units"/user/*.service; do
  [ -e "$unit" ] || continue
  name=$(basename "$unit")
  limit=$most
  [ "$(basename "$(dirname "$unit")")" != host ] || limit=$most_host
  # Only such a manager knows that it does not run as root.
  if [ "$(basename "$(dirname "$unit")")" = user ]; then
    sed 's/^\[Service\]$/&\nUser=somebody/' "$unit" >"$work/$name"
    unit=$work/$name
  fi
  verdict=$(systemd-analyze security --offline=true --no-pager --threshold="$limit" "$unit" 2>&1) || {
    echo "$verdict"
    echo "$name is more exposed than $limit tenths"
    status=1
  }
  tail -n 1 <<<"$verdict"
done
exit "$status"
