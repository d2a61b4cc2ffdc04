#!/usr/bin/env bash
# Lays out Debian's arm64 libraries of packages.txt in a folder of their own, to build against and to run under
# qemu-user. Nothing is installed on this computer: foreign packages beside its own would displace some of them.
#   tools/arm64_sysroot.sh FOLDER
# Needs no root. What is there already for the same packages is kept.
set -euo pipefail
cd "$(dirname "$0")/.."
mkdir -p "${1:?arm64_sysroot.sh FOLDER}"
root=$(cd "$1" && pwd)

codename=$(. /etc/os-release && echo "${VERSION_CODENAME:-unknown}")
packages=()
while read -r name flags; do
  case "$name" in lib* | *-dev) ;; *) continue ;; esac
  case " $flags " in *' amd64 '*) continue ;; esac
  packages+=("$name")
done <packages.txt

stamp="$codename $(cat tools/arm64_sysroot.sh packages.txt | cksum)"
[ "$(cat "$root/stamp" 2>/dev/null)" != "$stamp" ] || exit 0
rm -rf "${root:?}"/{stamp,etc,usr,var,lib,bin,sbin}
mkdir -p "$root"/apt/{state/lists/partial,cache/archives/partial} "$root"/usr/{lib,bin,sbin} "$root"/var/lib/dpkg/info
: >"$root/apt/status"
: >"$root/apt/preferences"
if [ "$codename" = bookworm ]; then
  # With their libraries (libcamera0.4, libgpiod3 ...), which have other names than the packages to build with.
  printf 'Package: src:libcamera src:libgpiod\nPin: release n=bookworm-backports\nPin-Priority: 990\n' \
    >"$root/apt/preferences"
fi

# apt sees a computer of arm64 on which nothing is installed.
apt_get() {
  apt-get -q -y --no-install-recommends -o APT::Architecture=arm64 -o APT::Architectures::=arm64 \
    -o APT::Sandbox::User="$(id -un)" -o Dir::State="$root/apt/state" -o Dir::State::status="$root/apt/status" \
    -o Dir::Cache="$root/apt/cache" -o Dir::Etc::preferences="$root/apt/preferences" \
    -o Debug::NoLocking=true -o Acquire::Languages=none "$@"
}
echo "Vantage: fetching the arm64 libraries ..." >&2
{ apt_get update && apt_get --download-only install "${packages[@]}"; } >"$root/apt/log" 2>&1 ||
  { tail -5 "$root/apt/log" >&2; exit 1; }

# One place for libraries, as on a running system.
for folder in bin sbin lib; do ln -s "usr/$folder" "$root/$folder"; done
database=$root/var/lib/dpkg
echo 1 >"$database/info/format"
printf 'amd64\narm64\n' >"$database/arch"
for archive in "$root"/apt/cache/archives/*.deb; do
  dpkg-deb --fsys-tarfile "$archive" | tar -x --keep-directory-symlink --no-same-owner -C "$root"
  # A list of packages good enough for dpkg-shlibdeps, which asks for files by where they lie here.
  fields=$(dpkg-deb -f "$archive")
  name=$(dpkg-deb -f "$archive" Package)
  case "$fields" in *'Multi-Arch: same'*) name=$name:arm64 ;; esac
  printf '%s\nStatus: install ok installed\n\n' "$fields" >>"$database/status"
  dpkg-deb --fsys-tarfile "$archive" | tar -t |
    sed -E "s,^\.,,; s,/$,,; s,^/(bin|sbin|lib)(/|$),/usr/\1\2,; s,^,$root," >"$database/info/$name.list"
  for kind in shlibs symbols; do
    dpkg-deb -I "$archive" $kind >"$database/info/$name.$kind" 2>/dev/null || rm "$database/info/$name.$kind"
  done
done
# Absolute links would lead into this computer's own libraries.
find "$root/usr" "$root/etc" -type l -lname '/*' -printf '%p\t%l\n' | while IFS=$'\t' read -r link target; do
  ln -sfn --relative "$root$target" "$link"
done
# What update-alternatives would do.
libraries=$root/usr/lib/aarch64-linux-gnu
for library in blas lapack; do
  ln -sfn "$library/lib$library.so.3" "$libraries/lib$library.so.3"
  ln -sfn "$library/lib$library.so.3" "$libraries/lib$library.so"
done
# Ceres names the libraries that it stands on by where they lie on a running system.
grep -rlE '[;"]/usr/lib/aarch64-linux-gnu/lib' "$libraries/cmake" |
  xargs -r sed -i -E "s,([;\"])(/usr/lib/aarch64-linux-gnu/lib),\1$root\2,g"
rm -rf "$root/apt/cache" "$root/apt/state"
echo "$stamp" >"$root/stamp"
