// Where each pixel's line of sight enters the visual hull (Matusik et al., 2000): the line is carried into every rig's
// picture, where its parts within the silhouette are those that may be the performer; where it first is within all of
// them, the hull begins.
#include "hull_rigs.glsl"

uniform sampler2D background_behind;  // its depth in this view, metres, 0 = none
uniform float has_background;         // 0: no background bounds the lines
uniform vec2 range_m;          // from and to which depth they are followed

layout(location = 0) out float hull_m;  // 0 = none

const int most_steps = 512;
const float step_px = 1.0;     // along the line's picture in the rig where that is longest
const int halvings = 6;

// Length in px of the line's picture, in the rig where that is longest.
float longest_px(vec2 pixel, vec2 range) {
    float longest = 1.0;
#define LENGTH(i)                                                                                   \
    {                                                                                               \
        vec4 a = pixel_from_target[i] * vec4(pixel * range.x, range.x, 1.0);                        \
        vec4 b = pixel_from_target[i] * vec4(pixel * range.y, range.y, 1.0);                        \
        if (a.z > 0.0 && b.z > 0.0) longest = max(longest, length(a.xy / a.z - b.xy / b.z));        \
    }
    FOR_RIGS(LENGTH)
    return longest;
}

vec4 at_inverse(vec2 pixel, float inverse_m) {
    float z = 1.0 / inverse_m;
    return vec4(pixel * z, z, 1.0);
}

void main() {
    hull_m = 0.0;
    vec2 pixel = gl_FragCoord.xy - 0.5, range = range_m;
    if (has_background > 0.0) {
        float behind = texelFetch(background_behind, ivec2(gl_FragCoord.xy), 0).r;
        if (behind > 0.0) range.y = min(range.y, behind);
    }
    if (range.y <= range.x) return;
    // Pictures of lines are even in inverse depth.
    int steps = min(int(ceil(longest_px(pixel, range) / step_px)), most_steps);
    float from = 1.0 / range.x, by = (1.0 / range.y - from) / float(steps);
    for (int k = 0; k <= steps; ++k) {
        float inside = from + float(k) * by;
        if (!in_hull(at_inverse(pixel, inside))) continue;
        float outside = k == 0 ? inside : inside - by;
        for (int h = 0; h < halvings; ++h) {
            float middle = 0.5 * (inside + outside);
            if (in_hull(at_inverse(pixel, middle)))
                inside = middle;
            else
                outside = middle;
        }
        hull_m = 1.0 / inside;
        return;
    }
}
