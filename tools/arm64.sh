#!/usr/bin/env bash
# Builds for rig computers with a 64-bit ARM processor on another computer: vantage-rig, its Debian package in
# build/arm64/packages, and the tests of wire and threads, which it runs under qemu-user.
#   tools/arm64.sh
# The package is for the Debian release that this computer runs.
set -euo pipefail
cd "$(dirname "$0")/.."
if [ "$(uname -m)" = aarch64 ]; then
  echo "arm64.sh: this computer is one itself; use cmake --build --preset release --target package" >&2
  exit 2
fi
tools/install_packages.sh test
tools/arm64_sysroot.sh build/arm64-sysroot
tools/build.sh arm64 vantage-rig vantage_thread_tests
(cd build/arm64 && cpack -D CPACK_COMPONENTS_ALL=rig >packages.log 2>&1) || { tail -20 build/arm64/packages.log >&2; exit 1; }
for package in build/arm64/packages/vantage-rig_*_arm64.deb; do
  echo "$package needs: $(dpkg-deb -f "$package" Depends)"
done
# Death tests start themselves anew, which the kernel refuses where binfmt knows no qemu.
tools/run_ctest.sh arm64 -L threads -E DeathTest
