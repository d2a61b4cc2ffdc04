#!/usr/bin/env bash
# Configures and builds one CMake preset, showing progress; builds only what is missing.
#   tools/build.sh PRESET [TARGET...]
#   tools/build.sh release programs    vantage-rig, vantage and vantage-calib, on a computer that need not have what tests use
set -euo pipefail
cd "$(dirname "$0")/.."
preset=$1
shift
log=build/$preset-configure.log
mkdir -p build
# One build folder serves ./run and ./test: the first finds the tests switched off and leaves the switch alone, the second
# switches them on, and neither makes the other compile anything again.
options=() targets=("$@")
if [ "$preset ${targets[*]}" = 'release programs' ]; then
  targets=(vantage-rig vantage vantage-calib)
elif [ "$preset" = release ]; then
  options=(-D VANTAGE_TESTS=ON)
fi
if ! cmake --preset "$preset" "${options[@]}" >"$log" 2>&1; then
  cat "$log" >&2
  exit 1
fi
# Two compilers of C++ with OpenCV and Eigen need about 1.5 GB each: a small computer gets fewer.
memory_gb=$(awk '/MemTotal/ {print int($2 / 1048576)}' /proc/meminfo)
jobs=$(nproc)
[ "$jobs" -le $((memory_gb * 2 / 3 + 1)) ] || jobs=$((memory_gb * 2 / 3 + 1))
[ ${#targets[@]} -eq 0 ] || targets=(--target "${targets[@]}")
NINJA_STATUS='[%f/%t %es] ' cmake --build --preset "$preset" -j "$jobs" "${targets[@]}"
