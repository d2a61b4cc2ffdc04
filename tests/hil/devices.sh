#!/usr/bin/env bash
# The device tests in the virtual machine: real drivers, and the very programs that were built. Two USB cameras, which
# are processes of this computer, are plugged into it.
#   devices.sh WORK TEST_PROGRAM USB_CAMERA_PROGRAM CAPTURE_TEST_PROGRAM
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=$1 program=$2 usb_camera=$3 capture_test=$4
data=${VANTAGE_DATA:-$here/../../../shared/data}
"$here/prepare.sh" "$work"

cameras=() sockets=$(mktemp -d)
end_cameras() {
  [ ${#cameras[@]} -eq 0 ] || kill "${cameras[@]}" 2>/dev/null || true
  rm -rf "$sockets"
}
trap end_cameras EXIT
qemu= material=()
if [ -d "$data/middlebury2003/teddy" ]; then
  material=("VANTAGE_DATA=$(realpath "$data")")
  # The slot is part of libcamera's names: it is fixed.
  qemu="-device qemu-xhci,id=usb,addr=10"
  port=1
  for picture in im2 im6; do
    socket=$sockets/camera$port # the path of a socket is short, and QEMU takes no space in it
    "$usb_camera" "$socket" "port$port" 320 240 10 "$data/middlebury2003/teddy/$picture.png" &
    cameras+=($!)
    for _ in $(seq 100); do [ -S "$socket" ] && break || sleep 0.1; done
    qemu+=" -chardev socket,id=camera$port,path=$socket -device usb-redir,chardev=camera$port,bus=usb.0,port=$port"
    port=$((port + 1))
  done
fi
HIL_QEMU=$qemu "$here/boot.sh" "$work" devices "HIL_TEST=$program" "HIL_CAPTURE_TEST=$capture_test" "HIL_RULES=$(realpath "$here/../../udev")" \
  "GTEST_FILTER=${GTEST_FILTER:-*}" "${material[@]}"
