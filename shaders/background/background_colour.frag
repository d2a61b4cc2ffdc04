// Temporal denoising of a rig's background: where it is visible, the mean colour of the instants since it last changed,
// elsewhere the colour that was seen before.
#include "colour_difference.glsl"
#include "tolerances.glsl"
#include "background_kinds.glsl"
#include "background_known.glsl"

uniform sampler2D picture;  // this instant's
uniform sampler2D before;   // mean of the instants before; alpha: instants without change, see background_known.glsl
uniform sampler2D shown_before;  // the denoised picture of the instant before
uniform sampler2D seen;     // from background_compare.frag
uniform sampler2D matte;    // the foreground's share
uniform float has_before;     // 0: there is no instant before
uniform float most_instants;  // of the mean

layout(location = 0) out vec4 shown;  // alpha: 1 where the background is visible now
layout(location = 1) out vec4 mean;

const float pixel_share = 0.4;  // of a pixel's own change, whose noise is larger than a window's
const float max_still_change = 1.0 / 255.0;  // change of the mean up to which a pixel keeps its colour: noise would flicker
const float hidden_from = 0.02; // matte around a pixel from which on it counts as hidden

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 size = vec2(textureSize(picture, 0)), uv = gl_FragCoord.xy / size;
    vec4 now = texelFetch(picture, at, 0);
    shown = vec4(now.rgb, 1.0);
    mean = vec4(now.rgb, 0.0);
    if (has_before == 0.0) return;
    vec4 past = texelFetch(before, at, 0);
    float hidden = 0.0;
    for (int k = 0; k < 4; ++k)
        hidden = max(hidden, textureLod(matte, uv + 1.5 / size * (2.0 * vec2(k & 1, k >> 1) - 1.0), 0.0).r);
    if (hidden > hidden_from) {
        mean = past;
        shown = vec4(past.rgb, 0.25);
        return;
    }
    vec2 here = textureLod(seen, uv, 0.0).rg;
    float change = max(here.g, pixel_share * largest(now.rgb - past.rgb));
    // A pixel that shows something else may go on changing; light and shadow pass over a background that stays known.
    bool is_other = is_kind(here.r, undecided) || is_kind(here.r, new_background);
    float instants = !is_other     ? min(past.a + 1.0, most_instants)
                     : past.a > 1.0 ? 0.5 * past.a
                                    : max(past.a - 1.0, min_still);
    mean = vec4(mix(past.rgb, now.rgb, max(1.0 / (max(instants, 0.0) + 1.0), smoothstep(noise_change, motion_change, change))), instants);
    vec3 kept = texelFetch(shown_before, at, 0).rgb;
    shown = vec4(largest(mean.rgb - kept) <= max_still_change ? kept : mean.rgb, 1.0);
}
