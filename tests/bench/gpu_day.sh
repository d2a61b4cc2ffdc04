#!/usr/bin/env bash
# All that a GPU should prove, in one go: what is there, the tests that draw, the benches, dma-buf paths.
#   tests/bench/gpu_day.sh [--small] [--build DIR]
# --small: sizes and repeats that a processor which draws everything gets through in minutes, to try the script itself.
# --build: programs that are there already (DIR/bin, DIR/gl_tests); without it build/release is brought up to date.
# Takes no network. Writes gpu.md to the folder $OUT, else to docs/results; every part also says there why it could not run.
# Ends with 1 if a test failed or a part that could run did not.
set -uo pipefail
cd "$(dirname "$0")/../.." || exit 1
small=false build=
while [ $# -gt 0 ]; do
  case "$1" in
    --small) small=true; shift ;;
    --build) build=${2:?--build needs a folder}; shift 2 ;;
    -h | --help) sed -n '2,7s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "gpu_day.sh: '$1' is not an option; --help lists them" >&2; exit 2 ;;
  esac
done
benches="stereo_bench synthesis_bench live_bench live_truth"
if [ -z "$build" ]; then
  build=build/release
  # shellcheck disable=SC2086
  tools/build.sh release vantage-rig vantage_gl_tests $benches >&2 || exit 1
fi
for program in vantage-rig $benches; do
  [ -x "$build/bin/$program" ] || { echo "gpu_day.sh: $build/bin has no $program: build it first, or leave out --build" >&2; exit 1; }
done
[ -s "$build/gl_tests" ] || { echo "gpu_day.sh: $build/gl_tests is missing: it names the tests that draw; configure with tests" >&2; exit 1; }

folder=${OUT:-docs/results}
mkdir -p "$folder"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
report=$work/gpu.md
failed=0
say() { printf '%s\n' "$*" | tee -a "$report"; }
note() { echo "gpu_day: $*" >&2; }
# The report is there after every part, so that an hour that ends early is not lost.
keep() { cp "$report" "$folder/gpu.md.new" && mv "$folder/gpu.md.new" "$folder/gpu.md"; }

# What is there.
probe=$work/probe.json
"$build/bin/vantage-rig" probe --json >"$probe" 2>"$work/probe.log" || true
text_of() { sed -n "s/^ *\"$1\": \"\(.*\)\",\{0,1\}$/\1/p" "$probe" | head -n 1; }
truth_of() { sed -n "s/^ *\"$1\": \(true\|false\),\{0,1\}$/\1/p" "$probe" | head -n 1; }
renderer=$(text_of renderer)
say "# On a GPU"
say ""
say "Written by \`tests/bench/gpu_day.sh$($small && echo ' --small')\` on $(date -u +%Y-%m-%d), $(nproc) processor cores."
say ""
say "| | |"
say "| --- | --- |"
cards=$(command -v nvidia-smi >/dev/null && nvidia-smi --query-gpu=name,driver_version --format=csv,noheader 2>/dev/null)
[ -z "$cards" ] || say "| card, driver | ${cards//$'\n'/; } |"
if [ -n "$renderer" ]; then
  say "| OpenGL ES | $renderer |"
  say "| vendor | $(text_of vendor) |"
  say "| version | $(text_of version) |"
  say "| reached by EGL's platform | $(text_of platform) |"
  say "| drawn by the processor | $(truth_of is_software) |"
else
  say "| OpenGL ES | none: $(grep -o '"outcome": *"[^"]*"' "$probe" | sed 's/"outcome": *//' | paste -sd ';' || true) |"
fi
say "| imports dma-bufs | $(truth_of EGL_EXT_image_dma_buf_import) |"
case "$cards" in
  *A100* | *A30* | *H100* | *H200* | *H800* | *B100* | *B200* | *V100* | *P100* | *MI[123]*)
    say ""
    say "A data-centre card: it has no screen and little hardware for drawing triangles; what draws is slower than on a card for"
    say "workstations, what computes is not."
    ;;
esac
if [ -n "$cards" ] && [ "$(truth_of is_software)" != false ]; then
  say ""
  say "There is a card, and EGL does not reach it: this container lacks its EGL library or does not find it"
  say "(\`libEGL_nvidia\`, and a file for it in \`/usr/share/glvnd/egl_vendor.d\` or \`__EGL_VENDOR_LIBRARY_FILENAMES\`). What"
  say "follows is the processor's."
fi
keep
if [ -z "$renderer" ]; then
  say ""
  say "Nothing below could run without OpenGL ES 3.1 by EGL."
  keep
  note "no OpenGL ES by EGL; see $folder/gpu.md"
  exit 1
fi

# The tests that draw: parts of their programs side by side, for compilers of shaders use one core each.
at_once=$((($(nproc) + 1) / 2))
parts=$(((at_once + 1) / 2))
say ""
say "## Tests"
say ""
names=$(cat "$build/gl_tests")
$small && names="gl_test rectification_test virtual_stage_test"
started=$SECONDS
note "tests of $(echo $names)"
export MESA_GLES_VERSION_OVERRIDE=3.1 GTEST_TOTAL_SHARDS=$parts
test_part() { # program, part: its log and how it ended, in $work
  GTEST_SHARD_INDEX=$2 timeout 1200 "$build/bin/$1" --gtest_color=no >"$work/$1.$2.log" 2>&1
  echo $? >"$work/$1.$2.ended"
}
export -f test_part
export build work
for program in $names; do
  seq 0 $((parts - 1)) | sed "s/^/$program /"
done | xargs -P $at_once -L 1 bash -c 'test_part "$@"' _
unset MESA_GLES_VERSION_OVERRIDE GTEST_TOTAL_SHARDS
say "$parts parts a program, $at_once at a time: $((SECONDS - started)) s."
say ""
say "| program | passed | failed | skipped |"
say "| --- | --- | --- | --- |"
remarks='' failures=''
sum() { sed -n "s/^\[  $2 *\] \([0-9]*\) test.*/\1/p" "$work/$1".*.log | awk '{n += $1} END {print n + 0}'; }
for name in $names; do
  faults=$(sed -n 's/^\[  FAILED  \] \([A-Za-z0-9_/]*\.[^ ,]*\).*/\1/p' "$work/$name".*.log | sort -u)
  count=$(printf '%s' "$faults" | grep -c . || true)
  say "| $name | $(sum "$name" PASSED) | $count | $(sum "$name" SKIPPED) |"
  for fault in $faults; do remarks+="- $fault failed"$'\n'; done
  failures+=$(grep -h -A3 ': Failure$' "$work/$name".*.log | head -n 20 | sed 's/^/    /')
  for part in $(seq 0 $((parts - 1))); do
    ended=$(cat "$work/$name.$part.ended")
    [ "$ended" -eq 0 ] || failed=1
    case $ended in
      0 | 1) ;;
      124) remarks+="- $name did not end within 20 minutes"$'\n' ;;
      *) remarks+="- $name ended with $ended: $(tail -n 1 "$work/$name.$part.log")"$'\n' ;;
    esac
  done
  remarks+=$(grep -ho 'SKIPPED: .*' "$work/$name".*.log | sort | uniq -c | sed "s/^ *\([0-9]*\) SKIPPED: /- $name, \1 of the tests: /")
  [ -z "$remarks" ] || [ "${remarks: -1}" = $'\n' ] || remarks+=$'\n'
done
[ -z "$remarks" ] || { say ""; printf '%s' "$remarks" | tee -a "$report"; }
[ -z "$failures" ] || { say ""; say "$failures"; }
keep

# Camera buffers without a copy.
say ""
say "## dma-buf"
say ""
if [ "$(truth_of EGL_EXT_image_dma_buf_import)" != true ]; then
  say "Not run: the driver does not import dma-bufs (EGL_EXT_image_dma_buf_import)."
elif [ ! -x "$build/bin/capture_test" ]; then
  say "Not run: $build/bin has no capture_test."
else
  "$build/bin/capture_test" --gtest_color=no --gtest_filter='*ImportsBuffers*' >"$work/dma_buf.log" 2>&1 || failed=1
  if grep -q 'SKIPPED: ' "$work/dma_buf.log"; then
    say "Not run: $(sed -n 's/.*SKIPPED: //p' "$work/dma_buf.log" | head -n 1)."
  else
    say "$(sed -n 's/^\[       OK \] \(.*\)/\1: passed/p; s/^\[  FAILED  \] \(.*\) (.*/\1: FAILED/p' "$work/dma_buf.log" | head -n 1)"
  fi
fi
keep

bench() { # title, program, options...: its tables
  local title=$1 program=$2
  shift 2
  note "$program $*"
  say ""
  say "## $title"
  say ""
  say "\`$program${*:+ $*}\`"
  say ""
  local ended=0
  timeout 3000 "$build/bin/$program" "$@" >"$work/bench.md" 2>"$work/bench.log" || ended=$?
  tee -a "$report" <"$work/bench.md"
  if [ $ended -ne 0 ]; then
    say ""
    say "It ended before its end: $(tail -n 1 "$work/bench.log")"
    failed=1
  fi
  keep
}

if $small; then
  bench "Live, small" live_bench --size 320x180 --rig-size 160x120 --rate 25 --rigs 1,2 --repeats 1
  bench "Matching" stereo_bench --gpu-times --repeats 1
  bench "Synthesis" synthesis_bench --stage-only --without-times
else
  bench "Live, 1080p50" live_bench --size 1920x1080 --rig-size 960x720 --rate 50 --rigs 4,8,16
  bench "Live, 2160p50" live_bench --size 3840x2160 --rig-size 960x720 --rate 50 --rigs 4,8,16
  bench "Matching" stereo_bench --gpu-times
  bench "Synthesis" synthesis_bench
  bench "Stereo" stereo_bench --random-scenes 2
  bench "The demo, live" live_truth live --seconds 20
fi
note "written: $folder/gpu.md"
exit $failed
