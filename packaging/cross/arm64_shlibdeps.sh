#!/bin/sh
# dpkg-shlibdeps, asked about programs for arm64 and the libraries of tools/arm64_sysroot.sh in $VANTAGE_SYSROOT.
exec env DEB_HOST_ARCH=arm64 dpkg-shlibdeps --admindir="$VANTAGE_SYSROOT/var/lib/dpkg" \
  -l"$VANTAGE_SYSROOT/usr/lib/aarch64-linux-gnu" "$@"
