#!/usr/bin/env bash
# Lets systemd judge the sandbox of every unit of hw_config/systemd and fails where one is more exposed than it may be.
#   tests/systemd/check_exposure.sh FOLDER_OF_UNITS
set -euo pipefail
units=$1
command -v systemd-analyze >/dev/null || { echo "SKIPPED: systemd-analyze is not installed (package systemd)"; exit 0; }

# In tenths, as --threshold takes them. ptp4l with hardware stamps faces the network, opens the interface's clock and
# switches its stamps on, which costs a capability and a device more than the others have.
most() {
  case $1 in vantage-ptp.service) echo 22 ;; *) echo 20 ;; esac
}
status=0
for unit in "$units"/*.service; do
  name=$(basename "$unit")
  verdict=$(systemd-analyze security --offline=true --no-pager --threshold="$(most "$name")" "$unit" 2>&1) || {
    echo "$verdict"
    echo "$name is more exposed than $(most "$name") tenths"
    status=1
  }
  tail -n 1 <<<"$verdict"
done
exit "$status"
