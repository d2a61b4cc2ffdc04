#!/usr/bin/env bash
# Builds every fuzz target, or those that are named, and runs each in turn on what it has found so far.
#   tests/fuzz/run_fuzz.sh [SECONDS a target, default 60] [TARGET...]
# Inputs are kept in build/fuzz/corpus/TARGET and grow from run to run; what broke a decoder is left in
# build/fuzz/found/ for `build/fuzz/bin/TARGET_fuzz FILE` to repeat. Closes with a line `N passed, N failed`.
set -uo pipefail
cd "$(dirname "$0")/../.."
seconds=60
if [ $# -gt 0 ]; then
  seconds=$1
  shift
fi
case "$seconds" in
  *[!0-9]* | "" | 0) echo "run_fuzz.sh: '$seconds' is no number of seconds above 0" >&2; exit 2 ;;
esac
targets=("$@")
if [ ${#targets[@]} -eq 0 ]; then
  tools/build.sh fuzz vantage_fuzz_targets || exit 1
else
  tools/build.sh fuzz make_seeds "${targets[@]/%/_fuzz}" || exit 1
fi

corpus=build/fuzz/corpus found=build/fuzz/found
mkdir -p "$corpus" "$found"
build/fuzz/bin/make_seeds "$corpus" || exit 1
# Debian's own interpreter has Debian's modules (python3-opencv, python3-pil).
if [ -x /usr/bin/python3 ]; then
  /usr/bin/python3 tests/fuzz/seeds/real_seeds.py "$corpus" || exit 1
else
  echo "SKIPPED: inputs of other programs: there is no /usr/bin/python3"
fi
if [ ${#targets[@]} -eq 0 ]; then
  for program in build/fuzz/bin/*_fuzz; do targets+=("$(basename "$program" _fuzz)"); done
fi

# Decoders log what they refuse; here they refuse thousands of times a second.
export VANTAGE_LOG=error
passed=0 failed=0
for target in "${targets[@]}"; do
  log=build/fuzz/$target.log
  mkdir -p "$corpus/$target"
  # Memory: a frame of the largest size takes 64 MB a picture; beyond four of these a decoder believes what it is told.
  if nice "build/fuzz/bin/${target}_fuzz" -max_total_time="$seconds" -timeout=100 -rss_limit_mb=2048 \
    -malloc_limit_mb=256 -max_len=65536 -print_final_stats=1 -artifact_prefix="$found/$target-" \
    "$corpus/$target" >"$log" 2>&1; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    grep -aE 'ERROR|SUMMARY|artifact_prefix|terminate|what\(\)' "$log" | tail -8
  fi
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log" | tail -1)
  echo "$target: ${runs:-no} executions, $(find "$corpus/$target" -type f | wc -l) inputs kept"
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
