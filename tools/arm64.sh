#!/usr/bin/env bash
# Builds for computers with a 64-bit ARM processor on another computer: the Debian packages in build/arm64/packages, which
# lintian looks at, and the tests of the rig's wire, threads, clocks and files, which it runs under qemu-user.
#   tools/arm64.sh        vantage-rig, vantage and vantage-calib
#   tools/arm64.sh rig    only vantage-rig: what a rig computer needs
#   tools/arm64.sh rig build     compiles that, and packs and runs nothing
# The packages are for the Debian release that this computer runs.
set -euo pipefail
cd "$(dirname "$0")/.."
case "${1-}" in
  '') programs=(vantage-rig vantage vantage-calib) components='rig;host;calib' ;;
  rig) programs=(vantage-rig) components=rig ;;
  *) echo "arm64.sh: '$1' cannot be packed; leave it out for all programs, or say rig" >&2; exit 2 ;;
esac
case "${2-}" in
  '' | build) ;;
  *) echo "arm64.sh: '$2' is not a word it knows; leave it out, or say build" >&2; exit 2 ;;
esac
if [ "$(uname -m)" = aarch64 ]; then
  echo "arm64.sh: this computer is one itself; use cmake --build --preset release --target package" >&2
  exit 2
fi
tools/install_packages.sh test
tools/arm64_sysroot.sh build/arm64-sysroot
tools/build.sh arm64 "${programs[@]}" vantage_arm64_tests
[ "${2-}" = build ] && exit
rm -rf build/arm64/packages
(cd build/arm64 && cpack -D CPACK_COMPONENTS_ALL="$components" >packages.log 2>&1) || { tail -20 build/arm64/packages.log >&2; exit 1; }
for package in build/arm64/packages/*_arm64.deb; do
  echo "$package needs: $(dpkg-deb -f "$package" Depends)"
done
tools/lint_packages.sh build/arm64/packages/*_arm64.deb
# Death tests start themselves anew, which the kernel refuses where binfmt knows no qemu.
GTEST_FILTER='-*DeathTest*' tools/run_ctest.sh arm64 -L arm64
