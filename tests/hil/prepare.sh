#!/usr/bin/env bash
# Makes what the virtual machine boots: Debian's kernel (unpacked, not installed), its gpio-sim module, v4l2loopback, a small
# initramfs. What is there already for the same kernel and sources is kept.
#   prepare.sh WORK
# Exits 77 with one line "SKIPPED: reason" where this computer lacks what it takes; with VANTAGE_HIL_REQUIRED in the
# environment that is a failure.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=${1:?prepare.sh WORK}
mkdir -p "$work"
cd "$work"
exec 9>lock && flock 9 # both tests boot what is made here

skip() {
  if [ -n "${VANTAGE_HIL_REQUIRED:-}" ]; then
    echo "hil: $1" >&2
    exit 1
  fi
  echo "SKIPPED: $1"
  exit 77
}
[ "$(uname -m)" = x86_64 ] || skip "the virtual machine runs x86_64 programs only, and this computer is $(uname -m)"
[ "$(id -u)" -eq 0 ] || sudo -n true 2>/dev/null ||
  skip "the virtual machine has this computer's files, which only root can read all: be root, or have sudo ask for no password"
for tool in qemu-system-x86_64:qemu-system-x86 busybox:busybox-static cpio:cpio /sbin/modprobe:kmod xz:xz-utils make:make; do
  command -v "${tool%%:*}" >/dev/null || skip "${tool%%:*} is missing (package ${tool#*:}; ./test installs it)"
done
headers=$(find /usr/src -maxdepth 1 -name 'linux-headers-*-amd64' | sort -V | tail -1)
[ -n "$headers" ] || skip "there are no kernel headers (package linux-headers-amd64; ./test installs it)"
release=${headers#/usr/src/linux-headers-}
source=$(find /usr/src -maxdepth 1 -name 'linux-source-*.tar.xz' | sort -V | tail -1)
[ -n "$source" ] || skip "there is no kernel source (package linux-source; ./test installs it)"

stamp="$release $(cat "$here"/prepare.sh "$here"/guest/initramfs_init "$here"/gpio_sim/* | cksum)"
[ "$(cat stamp 2>/dev/null)" != "$stamp" ] || exit 0
rm -rf stamp kernel source gpio_sim loopback initramfs

unpack() { # package, folder
  local file
  file=$(find . -maxdepth 1 -name "$1_*.deb" | head -1)
  if [ -z "$file" ]; then
    apt-get -qq download "$1" 2>download.log || skip "the package $1 cannot be had: $(grep -v '^W:' download.log | tail -1)"
    file=$(find . -maxdepth 1 -name "$1_*.deb" | head -1)
  fi
  dpkg-deb -x "$file" "$2"
}
unpack "linux-image-$release" kernel
unpack v4l2loopback-dkms loopback

name=$(basename "$source" .tar.xz)
mkdir source
xz -T0 -dc "$source" | tar x -C source --strip-components=1 "$name/drivers/gpio/gpio-sim.c" "$name/drivers/gpio/gpiolib.h" \
  "$name/kernel/irq/irq_sim.c" "$name/scripts/extract-vmlinux"

# QEMU starts the bare ELF kernel by PVH, which saves seconds of unpacking under emulation.
sh source/scripts/extract-vmlinux "kernel/boot/vmlinuz-$release" >vmlinux

cp -r "$here/gpio_sim" gpio_sim
cp source/drivers/gpio/gpiolib.h source/kernel/irq/irq_sim.c gpio_sim/
{
  echo 'struct gpio_chip;'
  echo 'static void gpio_sim_set_wired(struct gpio_chip *gc, unsigned int offset, int value);'
  echo 'static void gpio_sim_set_multiple_wired(struct gpio_chip *gc, unsigned long *mask, unsigned long *bits);'
  echo 'static int gpio_sim_direction_output_wired(struct gpio_chip *gc, unsigned int offset, int value);'
  sed -E 's/(gc->(set|set_multiple|direction_output) = gpio_sim_[a-z_]+);/\1_wired;/' source/drivers/gpio/gpio-sim.c
  echo '#include "wires.h"'
} >gpio_sim/gpio_sim.c
[ "$(grep -c '_wired;$' gpio_sim/gpio_sim.c)" -eq 3 ] ||
  skip "gpio-sim of $name is not as expected: its callbacks could not be wired"
# The kernel's makefiles know no folder whose name has a space.
modules=$(mktemp -d)
trap 'rm -rf "$modules"' EXIT
mkdir -p "kernel/lib/modules/$release/updates"
module() { # name, folder of its source
  cp -r "$2" "$modules/$1"
  make -s -C "$headers" M="$modules/$1" modules >"$1.log" 2>&1 || {
    cat "$1.log" >&2
    skip "$1 does not build against the headers of $release"
  }
  cp "$modules/$1/$1.ko" "kernel/lib/modules/$release/updates/"
}
module gpio-sim-wired gpio_sim
module v4l2loopback loopback/usr/src/v4l2loopback-*
/sbin/depmod -b kernel "$release"

mkdir -p initramfs/{bin,dev,proc,sys,host,layer,root,modules}
cp "$(command -v busybox)" initramfs/bin/busybox
install -m 755 "$here/guest/initramfs_init" initramfs/init
number=10
for module in virtio_pci 9pnet_virtio 9p overlay; do
  /sbin/modprobe -d kernel -S "$release" --show-depends "$module" | sed -n 's/^insmod \(.*[^ ]\) *$/\1/p'
done | awk '!seen[$0]++' >modules.list
while read -r module; do
  target=initramfs/modules/$number-$(basename "${module%.xz}")
  case $module in *.xz) xz -dc "$module" >"$target" ;; *) cp "$module" "$target" ;; esac
  number=$((number + 1))
done <modules.list
(cd initramfs && find . | cpio -o -H newc --quiet | gzip -1) >initrd.img
echo "$release" >release
echo "$stamp" >stamp
