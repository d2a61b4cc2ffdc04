#!/usr/bin/env bash
# Packs what was built, into PACKAGES/first, and the same under a next version, into PACKAGES/next.
#   make.sh BUILD_FOLDER PACKAGES
set -euo pipefail
build=$1 packages=$2
rm -rf "$packages"
mkdir -p "$packages/next"
packages=$(realpath "$packages")
(cd "$build" && cpack -B "$packages/first" >"$packages/cpack.log" 2>&1) || { tail -20 "$packages/cpack.log" >&2; exit 1; }
for package in "$packages"/first/*.deb; do
  opened=$packages/opened
  dpkg-deb -R "$package" "$opened"
  version=$(dpkg-deb -f "$package" Version)
  sed -i "s/^Version: .*/Version: $version+1/" "$opened/DEBIAN/control"
  dpkg-deb --root-owner-group -Zgzip -b "$opened" "$packages/next" >/dev/null
  rm -rf "$opened"
done
