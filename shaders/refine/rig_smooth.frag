// Smooths a rig's depth within surfaces: the mean inverse depth of the pixels around that lie on the same surface,
// weighted by the similarity of their colours. With SCALE 2 the result has half the size.
#include "tolerances.glsl"
#include "colour_difference.glsl"
#ifndef SCALE
#define SCALE 1
#endif
#ifndef REACH
#define REACH 2  // px of the result to either side
#endif

uniform sampler2D depth_map;  // metres, 0 = unknown
uniform sampler2D picture;

layout(location = 0) out float smoothed;

void main() {
    ivec2 size = textureSize(depth_map, 0);
    ivec2 at = SCALE * ivec2(gl_FragCoord.xy);
    float own = 0.0;
    for (int k = 0; k < SCALE * SCALE && own <= 0.0; ++k)
        own = texelFetch(depth_map, min(at + ivec2(k % SCALE, k / SCALE), size - 1), 0).r;
    smoothed = 0.0;
    if (own <= 0.0) return;
    vec2 texel = 1.0 / vec2(size);
    vec2 middle = vec2(at) + 0.5 * float(SCALE);
    vec3 colour = textureLod(picture, middle * texel, 0.0).rgb;
    float sum = 0.0, weights = 0.0;
    ivec2 low = max(at - REACH, ivec2(0)), high = min(at + REACH + SCALE - 1, size - 1);
    // Every other pixel suffices: neighbouring depths are nearly equal.
    for (int y = low.y; y <= high.y; y += 2)
        for (int x = low.x; x <= high.x; x += 2) {
            float z = texelFetch(depth_map, ivec2(x, y), 0).r;
            if (max(z, own) > min(z, own) * depth_edge_ratio) continue;
            vec3 there = textureLod(picture, (vec2(x, y) + 0.5) * texel, 0.0).rgb;
            float w = colour_weight(there, colour, smoothing_colour_falloff) + 1e-4;
            sum += w / z;
            weights += w;
        }
    // With SCALE 2 the one pixel with depth may not be among every other one.
    smoothed = weights > 0.0 ? weights / sum : own;
}
