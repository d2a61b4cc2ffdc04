#!/usr/bin/env bash
# Counts what OpenCV's block matchers cost the cores of a Raspberry Pi 5, without a Raspberry Pi: runs Debian's arm64 OpenCV,
# which uses NEON, under qemu-user on one thread, and counts the instructions of a frame with a plugin. Prints Markdown rows for
# docs/develop/adr/0001-match-on-the-gpu.md. Instruction counts are no times: the last column is what a Cortex-A76 needs at least.
#   tools/cores.sh [WIDTH HEIGHT DISPARITIES]     640 400 64 by default
# QEMU with plugins is Debian's package qemu-user, unpacked in $XDG_CACHE_HOME/vantage/cores (by default ~/.cache). Without root.
set -euo pipefail
cd "$(dirname "$0")/.."
width=${1:-640} height=${2:-400} disparities=${3:-64}
cache=${XDG_CACHE_HOME:-$HOME/.cache}/vantage/cores
sysroot=$PWD/build/arm64-sysroot
qemu=$cache/usr/bin/qemu-aarch64

if [ "$(uname -m)" != x86_64 ]; then
  echo "SKIPPED: cores: this is no amd64 computer"
  exit 0
fi
command -v aarch64-linux-gnu-g++ >/dev/null || {
  echo "SKIPPED: cores: there is no aarch64-linux-gnu-g++ (tools/install_packages.sh test)"
  exit 0
}
tools/arm64_sysroot.sh "$sysroot"
mkdir -p "$cache"
[ -x "$qemu" ] || (cd "$cache" && apt-get -q download qemu-user >&2 && dpkg -x qemu-user_*.deb .) || {
  echo "SKIPPED: cores: apt has no package qemu-user"
  exit 0
}
# QEMU 9 ended version 1 of the interface.
version=1
[[ $("$qemu" --version) =~ version\ (9|[1-9][0-9]) ]] && version=4
gcc -O2 -shared -fPIC "-DPLUGIN_VERSION=$version" tools/cores/count_instructions.c -o "$cache/count_instructions.so"
aarch64-linux-gnu-g++ -O2 -std=c++20 "--sysroot=$sysroot" -isystem "$sysroot/usr/include/opencv4" tools/cores/opencv_frame.cpp \
  -o "$cache/opencv_frame" -L "$sysroot/usr/lib/aarch64-linux-gnu" "-Wl,-rpath-link,$sysroot/usr/lib/aarch64-linux-gnu" \
  -lopencv_calib3d -lopencv_imgproc -lopencv_core

# counts MODE REPEATS
counts() {
  local log=$cache/counts.log
  "$qemu" -L "$sysroot" -plugin "$cache/count_instructions.so" -d plugin -D "$log" "$cache/opencv_frame" "$1" "$width" "$height" \
    "$disparities" "$2" >"$cache/found"
  sed -n 's/^INSTRUCTIONS //p' "$log"
}

echo "| matcher, ${width}x${height}x${disparities} | M instructions per frame | vector arithmetic | loads and stores | ms of one core at least |"
echo "| --- | --- | --- | --- | --- |"
for mode in 3way bm; do
  name='StereoSGBM, 3WAY'
  [ "$mode" = bm ] && name='StereoBM, block 15'
  # Between one frame and three lie two, without the program's start. A Cortex-A76 decodes four instructions per cycle, and
  # has two pipes for vectors and two for memory.
  { counts "$mode" 1; counts "$mode" 3; } | awk -v name="$name" '
    NR == 1 { for (i = 1; i <= 4; ++i) before[i] = $i }
    NR == 2 {
      for (i = 1; i <= 4; ++i) count[i] = ($i - before[i]) / 2e6
      memory = count[3] + count[4]
      cycles = count[1] / 4
      if (count[2] / 2 > cycles) cycles = count[2] / 2
      if (memory / 2 > cycles) cycles = memory / 2
      printf "| %s | %.0f | %.0f | %.0f | %.1f |\n", name, count[1], count[2], memory, cycles / 2.4
    }'
done
