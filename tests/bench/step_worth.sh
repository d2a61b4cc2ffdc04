#!/usr/bin/env bash
# What each step of the live picture is worth: live_truth's figures with one after the other left out.
#   tests/bench/step_worth.sh [--sets LIST] [--jobs N] [STEP...] [-- OPTIONS]
# --sets: of the virtual stage (default 4,7,10,13,16,18). --jobs: sets at a time (default: processors).
# STEP: only these, by their names below. OPTIONS: of live_truth stepped. Writes a Markdown table to stdout, means over
# the sets. A step is left out by changing a shader (VANTAGE_SHADERS). Needs build/release/bin/live_truth; takes three
# minutes a step and processor for six sets.
set -euo pipefail
cd "$(dirname "$0")/../.."
sets=4,7,10,13,16,18 jobs=$(nproc) wanted=() options=()
while [ $# -gt 0 ]; do
  case "$1" in
    --sets) sets=${2:?--sets needs numbers, 4,7 for example}; shift 2 ;;
    --jobs) jobs=${2:?--jobs needs a number}; shift 2 ;;
    -h | --help) sed -n '2,7s/^# \{0,1\}//p' "$0"; exit 0 ;;
    --) shift; options=("$@"); break ;;
    -*) echo "step_worth.sh: '$1' is not an option; --help lists them" >&2; exit 2 ;;
    *) wanted+=("$1"); shift ;;
  esac
done
truth=build/release/bin/live_truth
[ -x "$truth" ] || { echo "step_worth.sh: $truth is missing: tools/build.sh release live_truth" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Step | words | shader | sed expression
steps='nothing|nothing||
silhouettes|performers held by other rigs'"'"' silhouettes (2)|foreground_carve.frag|s/if (look_at_silhouettes(pixel, z) >= 0) carved = z;/carved = z;/
smoothing|their depth smoothed (2)|foreground_depth.frag|s/smooth_weight = 0.24/smooth_weight = 0.0/
unmixing|the set taken out of their edges (1)|foreground_colour.frag|s/if (share == 0.0 .. share == 1.0) return;/return;/
floor|the floor (3)|rig_floor.frag|s/if (own <= 0.0 .. nearness < horizon) return;/return;/
moving|depth moved to where pictures agree (4)|rig_carve.frag|s/if (doubts) z = moved(at, z, share);//
carving|what others see through carved away (4)|rig_carve.frag|s/if (through > support) z = 0.0;//
adoption|confirmed depth taken over (4)|rig_adopt.frag|s/if (own.g != 0.0) return;/return;/
votes|rigs vote for surfaces (6)|fused_depth.frag|s/^bool is_there(vec2 pixel, float z) {/\0 return true;/
trust|colours trusted less beside edges (7)|edge_confidence.frag|s/trust = mix(least_trust, 1.0, pure \* pure);/trust = 1.0;/
sharpness|colours as sharp as the view (7)|fused_colour.frag|s/if (fine \&\& lod/if (false \&\& lod/
doubts|rigs'"'"' colours decide at edges (8)|fused_colour.frag|s/^float doubt(Evidence e) {/\0 if (e.weight > 0.0) return 0.0;/
specks|specks (12)|impulse_filter.frag|s/leave_to_second(!is_one_surface(at));/leave_to_second(false);/'

for step in ${wanted[@]+"${wanted[@]}"}; do
  grep -q "^$step|" <<<"$steps" ||
    { echo "step_worth.sh: there is no step '$step', only $(cut -d'|' -f1 <<<"$steps" | paste -sd' ')" >&2; exit 2; }
done

# The means of rows, from PSNR on, as cells.
means() {
  awk -F'|' '{ sub(/%/, "", $8); for (i = 4; i <= 11; ++i) sum[i] += $i }
    END { printf " %.2f | %.2f | %.2f | %.4f | %.2f %% | %.2f | %.2f | %.2f |",
      sum[4] / NR, sum[5] / NR, sum[6] / NR, sum[7] / NR, sum[8] / NR, sum[9] / NR, sum[10] / NR, sum[11] / NR }'
}
echo "| without | PSNR dB | of the set | of performers | SSIM | debris | performers' edges | wavering: set | performers |"
echo "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"
while IFS='|' read -r step words shader change; do
  [ ${#wanted[@]} -eq 0 ] || [[ " ${wanted[*]} " == *" $step "* ]] || continue
  rm -rf "$work/shaders"
  mkdir "$work/shaders"
  if [ -n "$shader" ]; then
    sed "$change" "shaders/$shader" >"$work/shaders/$shader"
    ! cmp -s "shaders/$shader" "$work/shaders/$shader" ||
      { echo "step_worth.sh: $shader has changed: say anew how to leave out '$step'" >&2; exit 1; }
  fi
  rows=$(tr , '\n' <<<"$sets" | VANTAGE_SHADERS=$work/shaders xargs -P "$jobs" -I{} \
    "$truth" stepped --without-times --sets {} "${options[@]}" | grep '^| fused')
  echo "| $words |$(means <<<"$rows")"
done <<<"$steps"
