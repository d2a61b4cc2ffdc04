#!/usr/bin/env bash
# The Debian packages in the virtual machine: installed, booted, upgraded, purged.
#   packages.sh WORK BUILD_FOLDER
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=$1 build=$2
"$here/prepare.sh" "$work"
command -v dpkg-shlibdeps >/dev/null || { echo "SKIPPED: dpkg-shlibdeps is missing (package dpkg-dev)"; exit 77; }
rm -rf "$work/packages-first" "$work/packages-next"
(
  cd "$build"
  cpack -B "$work/packages-first" >"$work/cpack.log" 2>&1
  version=$(dpkg-deb -f "$work"/packages-first/vantage-rig_*.deb Version)
  cpack -B "$work/packages-next" -D "CPACK_PACKAGE_VERSION=$version+1" >>"$work/cpack.log" 2>&1
) || { tail -20 "$work/cpack.log" >&2; exit 1; }
"$here/../../tools/lint_packages.sh" "$work"/packages-first/*.deb || exit 1
HIL_QEMU="-netdev user,id=card,restrict=on -device e1000e,netdev=card" HIL_INIT=init_systemd HIL_TIMEOUT_S=2700 exec "$here/boot.sh" "$work" packages \
  "HIL_DOCUMENTS=$(realpath "$here/../documents")" "PACKAGES=$(realpath "$work/packages-first")" "UPGRADE=$(realpath "$work"/packages-next/vantage-rig_*.deb)"
