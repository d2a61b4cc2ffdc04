// Moves every pixel's depth to the depth of the least cost in a window around it.
#include "tolerances.glsl"
#include "colour_difference.glsl"
#ifndef REACH
#define REACH 2  // px from the middle to the sides of the window
#endif

uniform sampler2D depth_map;  // metres, 0 = unknown
uniform sampler2D picture;
uniform sampler2D costs[4];   // at sixteen depths, from rig_sweep.frag
uniform float relative_step;  // of inverse depth, from one to the next

layout(location = 0) out float refined;

const float step_penalty = 0.01;  // of cost, for every step away from the present depth
const int no_move = 7;            // the step that leaves the depth as it is

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), size = textureSize(depth_map, 0);
    float own = texelFetch(depth_map, at, 0).r;
    refined = own;
    if (own <= 0.0) return;
    vec2 texel = 1.0 / vec2(size);
    vec3 colour = textureLod(picture, (vec2(at) + 0.5) * texel, 0.0).rgb;
    vec4 a = vec4(0.0), b = a, c = a, d = a;
    float weights = 0.0;
    // Every other pixel suffices: neighbouring costs are nearly equal.
    for (int y = -REACH; y <= REACH; y += 2)
        for (int x = -REACH; x <= REACH; x += 2) {
            ivec2 there = clamp(at + ivec2(x, y), ivec2(0), size - 1);
            float z = texelFetch(depth_map, there, 0).r;
            if (max(z, own) > min(z, own) * depth_edge_ratio) continue;
            float w = colour_weight(textureLod(picture, (vec2(there) + 0.5) * texel, 0.0).rgb, colour, window_colour_falloff) + 1e-4;
            a += w * texelFetch(costs[0], there, 0);
            b += w * texelFetch(costs[1], there, 0);
            c += w * texelFetch(costs[2], there, 0);
            d += w * texelFetch(costs[3], there, 0);
            weights += w;
        }
    float cost[16] = float[16](a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w, c.x, c.y, c.z, c.w, d.x, d.y, d.z, d.w);
    int best = no_move;
    for (int h = 0; h < 16; ++h) {
        cost[h] = cost[h] / weights + step_penalty * abs(float(h - no_move));
        if (cost[h] < cost[best]) best = h;
    }
    float steps = float(best - no_move);
    if (best > 0 && best < 15) {
        float bend = cost[best - 1] + cost[best + 1] - 2.0 * cost[best];
        if (bend > 1e-5) steps += clamp(0.5 * (cost[best - 1] - cost[best + 1]) / bend, -0.5, 0.5);
    }
    refined = own / (1.0 + steps * relative_step);
}
