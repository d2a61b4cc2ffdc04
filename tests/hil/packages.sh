#!/usr/bin/env bash
# The Debian packages in the virtual machine: installed, booted, upgraded, purged.
#   packages.sh WORK PACKAGES     after tests/packages/make.sh
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=$1 packages=$(realpath "$2")
"$here/prepare.sh" "$work"
"$here/../../tools/lint_packages.sh" "$packages"/first/*.deb || exit 1
HIL_QEMU="-netdev user,id=card,restrict=on -device e1000e,netdev=card" HIL_INIT=init_systemd HIL_TIMEOUT_S=2700 exec "$here/boot.sh" "$work" packages \
  "HIL_DOCUMENTS=$(realpath "$here/../documents")" "PACKAGES=$packages/first" "UPGRADE=$(echo "$packages"/next/vantage-rig_*.deb)"
