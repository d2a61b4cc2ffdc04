// Inpaints the depth of pixels that have none from the nearest known pixels in eight directions, those of similar colour
// above all. A place that only one of two cameras sees is mostly background beside it, but a matcher also leaves out plain
// and shiny surfaces, which continue there.
#include "tolerances.glsl"
#include "colour_difference.glsl"

uniform sampler2D depth_map;  // metres, 0 = unknown, negative = inpainted
uniform sampler2D measured;   // metres: the depth before other rigs carved some of it away
uniform sampler2D picture;    // of the same rig

layout(location = 0) out float inpainted;  // negative where it was unknown, 0 where no known pixel is near

const int directions = 8, steps = 9;
const float step_growth = 1.5;  // from one step to the next; the first is 1 px
const float nearer_weight = 0.1;  // of a surface that is nearer than the farthest one, of equal colour and distance

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), size = textureSize(depth_map, 0);
    inpainted = texelFetch(depth_map, at, 0).r;
    // Depth that was carved away must not come back from its remains.
    if (inpainted != 0.0 || texelFetch(measured, at, 0).r != 0.0) return;
    vec2 texel = 1.0 / vec2(size), middle = (vec2(at) + 0.5) * texel;
    vec3 own = textureLod(picture, middle, 0.0).rgb;
    float z[directions], weight[directions], farthest = 0.0;
    for (int k = 0; k < directions; ++k) {
        float angle = 6.2831853 * float(k) / float(directions);
        vec2 along = vec2(cos(angle), sin(angle));
        float away = 1.0;
        z[k] = 0.0;
        for (int i = 0; i < steps && z[k] <= 0.0; ++i) {
            ivec2 there = at + ivec2(floor(along * away + 0.5));
            if (any(lessThan(there, ivec2(0))) || any(greaterThanEqual(there, size))) break;
            z[k] = max(texelFetch(depth_map, there, 0).r, 0.0);
            if (z[k] > 0.0) {
                vec3 colour = textureLod(picture, (vec2(there) + 0.5) * texel, 0.0).rgb;
                weight[k] = colour_weight(colour, own, inpaint_colour_falloff) / away + 1e-6;
            }
            away *= step_growth;
        }
        farthest = max(farthest, z[k]);
    }
    if (farthest == 0.0) return;
    // The mean inverse depth of the surface with the most weight.
    float most = 0.0, inverse = 0.0;
    for (int k = 0; k < directions; ++k) {
        if (z[k] <= 0.0) continue;
        float sum = 0.0, sum_inverse = 0.0;
        for (int j = 0; j < directions; ++j) {
            if (z[j] <= 0.0 || max(z[j], z[k]) > min(z[j], z[k]) * depth_edge_ratio) continue;
            sum += weight[j];
            sum_inverse += weight[j] / z[j];
        }
        float score = sum * (z[k] * depth_edge_ratio < farthest ? nearer_weight : 1.0);
        if (score > most) {
            most = score;
            inverse = sum_inverse / sum;
        }
    }
    inpainted = -1.0 / inverse;
}
