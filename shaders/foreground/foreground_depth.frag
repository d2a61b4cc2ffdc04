// The depth of a rig's foreground: the measured depth, or that of the nearest surface around where it is missing, smoothed
// within surfaces. Depth continues for some pixels outside the matte, as a negative number, unless the background is in
// front of it: the matte ends the foreground, and not the depth map.
#ifndef FAR
#define FAR 0  // 1: also use the depth of foreground_far.frag
#endif
#include "foreground_blocks.glsl"

uniform sampler2D depth_map;  // metres, 0 = unknown
uniform sampler2D matte;      // the foreground's share of each pixel
uniform sampler2D background_depth;  // metres
#if FAR
uniform sampler2D far_depth;  // metres, 0 = none
#endif
uniform float edge_ratio;     // two depths whose ratio is larger lie on two surfaces

layout(location = 0) out float performer_m;  // metres, 0 = nothing, negative = beyond the matte

// Neighbours in rings of eight.
const int rings = 3, ring_taps = 8;
const ivec2 taps[rings * ring_taps] = ivec2[](
    ivec2(1, 2), ivec2(-1, 2), ivec2(-2, 1), ivec2(-2, -1), ivec2(-1, -2), ivec2(1, -2), ivec2(2, -1), ivec2(2, 1),
    ivec2(3, 3), ivec2(0, 4), ivec2(-3, 3), ivec2(-4, 0), ivec2(-3, -3), ivec2(0, -4), ivec2(3, -3), ivec2(4, 0),
    ivec2(2, 6), ivec2(-2, 6), ivec2(-6, 2), ivec2(-6, -2), ivec2(-2, -6), ivec2(2, -6), ivec2(6, -2), ivec2(6, 2));
#ifdef WITHOUT_SMOOTHING  // tests/bench/step_worth.py
const float smooth_weight = 0.0;
#else
const float smooth_weight = 0.24;  // of each pixel of the first ring in the mean, the centre being 1
#endif
const float none = 1e9;

float nearer(float nearest, float z) { return z > 0.0 ? min(nearest, z) : nearest; }
float depth_at(ivec2 at) { return texelFetch(depth_map, clamp(at, ivec2(0), textureSize(depth_map, 0) - 1), 0).r; }

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float measured = depth_at(at), nearest = none;
    float around[ring_taps];
    for (int k = 0; k < ring_taps; ++k) {
        around[k] = depth_at(at + taps[k]);
        nearest = nearer(nearest, around[k]);
    }
    for (int ring = 1; ring < rings; ++ring) {
        float farther = none;
        for (int k = 0; k < ring_taps; ++k) farther = nearer(farther, depth_at(at + taps[ring_taps * ring + k]));
        nearest = nearest == none ? farther : nearest;
    }
    bool is_alone = nearest == none;
    if (is_alone) nearest = 0.0;
    if (textureLod(matte, gl_FragCoord.xy / vec2(textureSize(depth_map, 0)), 0.0).r == 0.0) {
        float behind = texelFetch(background_depth, at, 0).r;
        performer_m = behind <= 0.0 || behind > nearest ? -nearest : 0.0;
        return;
    }
#if FAR
    if (is_alone) nearest = texelFetch(far_depth, at / block_px, 0).r;
#endif
    float depth = measured > 0.0 ? measured : nearest;
    float all = 1.0, sum = 1.0 / max(depth, 1e-3);
    for (int k = 0; k < ring_taps; ++k) {
        float w = max(around[k], depth) > min(around[k], depth) * edge_ratio ? 0.0 : smooth_weight;
        sum += w / max(around[k], 1e-3);
        all += w;
    }
    performer_m = depth > 0.0 ? all / sum : 0.0;
}
