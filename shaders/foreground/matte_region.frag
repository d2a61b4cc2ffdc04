// Whether a block of pixels lies within a region of foreground: the share of the directions in which the first decided
// pixels are foreground. A plain surface has depth at its edges only, and its inside may look like the background in
// another light: foreground encloses it, whereas a shadow has the background on most sides.
#include "foreground_blocks.glsl"

uniform sampler2D votes;  // from matte_votes.frag, with mip levels

layout(location = 0) out float enclosed;

const int directions = 8, reaches = 6;
const float first_reach_px = 3.0;  // doubled from one to the next
const float decided = 0.3;         // share of decided pixels from which on they count
const float min_directions = 4.0;  // that meet decided pixels

void main() {
    vec2 texel = 1.0 / vec2(textureSize(votes, 0));
    vec2 uv = (float(block_px) * (gl_FragCoord.xy - 0.5) + 0.5 * float(block_px)) * texel;
    float foreground = 0.0, met = 0.0;
    for (int k = 0; k < directions; ++k) {
        float angle = 6.2831853 * (float(k) + 0.5) / float(directions);
        vec2 direction = vec2(cos(angle), sin(angle)) * texel;
        float reach = first_reach_px;
        for (int step = 0; step < reaches; ++step) {
            vec2 there = textureLod(votes, uv + reach * direction, log2(reach) - 1.0).rg;
            if (there.r + there.g > decided) {
                foreground += there.r > there.g ? 1.0 : 0.0;
                met += 1.0;
                break;
            }
            reach *= 2.0;
        }
    }
    enclosed = met < min_directions ? 0.0 : foreground / met;
}
