#!/usr/bin/env bash
# Lets systemd itself read the units of hw_config/systemd and fails on whatever it complains of, an option that it does
# not know included.
#   tests/systemd/check_units.sh FOLDER_OF_UNITS VANTAGE_RIG
set -euo pipefail
units=$1 rig=$2
skip() { echo "SKIPPED: $1"; exit 0; }
command -v systemd-analyze >/dev/null || skip "systemd-analyze is not installed (package systemd)"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# The daemon is where it was built, and linuxptp need not be here.
for unit in "$units"/*.service "$units"/host/*.service; do
  [ -e "$unit" ] || continue
  sed -e "s#^ExecStart=/usr/bin/vantage-rig#ExecStart=\"$rig\"#" -e 's#^ExecStart=/usr/sbin/\S*#ExecStart=/bin/true#' "$unit" \
    >"$work/$(basename "$unit")"
done
status=0
complaints=$(systemd-analyze verify --man=no --recursive-errors=one "$work"/*.service 2>&1 >/dev/null) || status=$?
# Of other units than these it may complain as it likes.
if [ "$status" -ne 0 ] || grep -F "$work" <<<"$complaints"; then
  echo "$complaints"
  exit 1
fi
# Those of a user's own manager.
if [ -d "$units/user" ]; then
  mkdir "$work/user"
  for unit in "$units"/user/*.service; do
    sed 's#^ExecStart=/usr/bin/\S*#ExecStart=/bin/true#' "$unit" >"$work/user/$(basename "$unit")"
  done
  XDG_RUNTIME_DIR=$work systemd-analyze --user verify --man=no --recursive-errors=one "$work"/user/*.service
fi
echo "systemd read $(find "$units" -name '*.service' | wc -l) units without complaint"
