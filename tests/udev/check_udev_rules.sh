#!/usr/bin/env bash
# Lets udev itself read the rules of udev/ and fails on whatever it complains of.
#   tests/udev/check_udev_rules.sh FOLDER_OF_RULES
# With systemd 254 or newer by `udevadm verify`. Older ones have none: there udevadm is made to load them, in a mount
# namespace of its own where no other rules are, which takes root. Where neither is possible it says SKIPPED.
set -euo pipefail
rules=$1
skip() { echo "SKIPPED: $1"; exit 0; }
command -v udevadm >/dev/null || skip "udevadm is not installed (package udev)"

if udevadm verify --help >/dev/null 2>&1; then
  exec udevadm verify --no-style --resolve-names=never "$rules"/*.rules
fi
[ "$(id -u)" -eq 0 ] || skip "this udevadm has no verify, and making it load the rules takes root"
unshare -m true 2>/dev/null || skip "this udevadm has no verify, and there are no mount namespaces here"
# The groups that the rules name are made where the packages are installed, not here: in the namespace they exist.
# Errors are logged with the file and the line; a rule that matches nothing is read all the same.
log=$(unshare -m bash -c '
  for folder in /run /etc/udev/rules.d /usr/lib/udev/rules.d; do
    [ ! -d "$folder" ] || mount -t tmpfs none "$folder"
  done
  cp "$1"/*.rules /usr/lib/udev/rules.d/
  cp /etc/group /run/group
  sed -n "s/.*GROUP=\"\([a-z-]*\)\".*/\1:x:9999:/p" "$1"/*.rules | sort -u >>/run/group
  mount --bind /run/group /etc/group
  udevadm test --action=add /sys/class/net/lo 2>&1' bash "$rules") || true
if grep -E '\.rules:[0-9]+' <<<"$log"; then
  exit 1
fi
files=$(ls "$rules"/*.rules | wc -l)
if [ "$(grep -c 'Reading rules file' <<<"$log")" -ne "$files" ]; then
  echo "udev did not read the rules: $log"
  exit 1
fi
echo "udev read $files files of rules without complaint"
