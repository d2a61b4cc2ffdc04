// Vertical permeability aggregation of one slab, then winner takes all. An invocation walks a column down and back
// up; on the way up the sums are complete, and the best disparity so far is kept for every pixel with its two
// neighbours' costs (for sub-pixel positions), so that slabs follow one another through the same small volume.
#include "perm_common.glsl"

// Disparities of this slab that count, 1..16.
#ifndef VALID
#define VALID 16
#endif

layout(local_size_x = LANES) in;
layout(std430, binding = 0) readonly buffer Permeability { uint permeability[]; };
layout(std430, binding = 1) readonly buffer Volume { uvec2 volume[]; };
layout(std430, binding = 2) buffer Down { uvec4 down[]; };
// x: cost << 20 | disparity << 12 | cost of the last disparity seen; y: cost of the disparity before the best << 12 |
// of the one after (0xfff: there is none).
layout(std430, binding = 3) buffer Winners { uvec2 winners[]; };
uniform ivec2 size;
uniform int stride;
uniform int first_disparity;

#define CONSIDER(i, s)                             \
    if (i < VALID) {                               \
        uint cost = s;                             \
        bool wins = cost < best;                   \
        after = d == best_d + 1u ? cost : after;   \
        before = wins ? last : before;             \
        after = wins ? 0xfffu : after;             \
        best_d = wins ? d : best_d;                \
        best = min(best, cost);                    \
        last = cost;                               \
        d += 1u;                                   \
    }
#define CONSIDER2(k, w) CONSIDER(2 * k, (w) & 0xffffu) CONSIDER(2 * k + 1, (w) >> 16)

void main() {
    int x = int(gl_GlobalInvocationID.x);
    if (x >= size.x) return;

    uvec4 a = uvec4(0u), b = uvec4(0u);
    for (int y = 0; y < size.y; ++y) {
        int at = y * stride + x;
        uint mu = permeability[at] >> 4;
        a = pairs_of(volume[at * 2]) + permeate(a, mu);
        b = pairs_of(volume[at * 2 + 1]) + permeate(b, mu);
        down[at * 2] = a;
        down[at * 2 + 1] = b;
    }

    // Now a and b are the sums from below.
    a = uvec4(0u), b = uvec4(0u);
    uint mu = 0u;
    for (int y = size.y - 1; y >= 0; --y) {
        int at = y * stride + x;
        a = permeate(a, mu);
        b = permeate(b, mu);
        uvec4 sum_a = down[at * 2] + a, sum_b = down[at * 2 + 1] + b;
        a += pairs_of(volume[at * 2]);
        b += pairs_of(volume[at * 2 + 1]);
        mu = permeability[at] >> 4;

        uint best = 0xfffu, best_d = 0xfff0u, before = 0xfffu, after = 0xfffu, last = 0xfffu;
        if (first_disparity > 0) {
            uvec2 state = winners[at];
            best = state.x >> 20;
            best_d = (state.x >> 12) & 255u;
            last = state.x & 0xfffu;
            before = state.y >> 12;
            after = state.y & 0xfffu;
        }
        uint d = uint(first_disparity);
        CONSIDER2(0, sum_a.x)
        CONSIDER2(1, sum_a.y)
        CONSIDER2(2, sum_a.z)
        CONSIDER2(3, sum_a.w)
        CONSIDER2(4, sum_b.x)
        CONSIDER2(5, sum_b.y)
        CONSIDER2(6, sum_b.z)
        CONSIDER2(7, sum_b.w)
        winners[at] = uvec2((best << 20) | (best_d << 12) | last, (before << 12) | after);
    }
}
