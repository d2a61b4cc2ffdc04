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
layout(std430, binding = 1) buffer Volume { uvec4 volume[]; };
// x: cost << 16 | disparity; y: cost of the disparity before << 16 | after (0xffff: there is none);
// z: cost of the last disparity seen.
layout(std430, binding = 2) buffer Winners { uvec4 winners[]; };
uniform ivec2 size;
uniform int stride;
uniform int first_disparity;

#define CONSIDER(i, s)                             \
    if (i < VALID) {                               \
        uint cost = s;                             \
        bool wins = cost < best;                   \
        after = d == best_d + 1u ? cost : after;   \
        before = wins ? last : before;             \
        after = wins ? 0xffffu : after;            \
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
        a = volume[at * 2] + permeate(a, mu);
        b = volume[at * 2 + 1] + permeate(b, mu);
        volume[at * 2] = a;
        volume[at * 2 + 1] = b;
    }

    uvec4 back_a = uvec4(0u), back_b = uvec4(0u);
    uint mu_below = 0u;
    for (int y = size.y - 1; y >= 0; --y) {
        int at = y * stride + x;
        int above = y > 0 ? at - stride : at;
        uvec4 before_a = volume[above * 2], before_b = volume[above * 2 + 1];
        uint mu = permeability[at] >> 4;
        back_a = permeate(back_a, mu_below);
        back_b = permeate(back_b, mu_below);
        uvec4 sum_a = a + back_a, sum_b = b + back_b;
        back_a += a - permeate(before_a, mu);
        back_b += b - permeate(before_b, mu);
        mu_below = mu;
        a = before_a;
        b = before_b;

        uint best = 0xffffu, best_d = 0xfff0u, before = 0xffffu, after = 0xffffu, last = 0xffffu;
        if (first_disparity > 0) {
            uvec4 state = winners[at];
            best = state.x >> 16;
            best_d = state.x & 0xffffu;
            before = state.y >> 16;
            after = state.y & 0xffffu;
            last = state.z;
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
        winners[at] = uvec4((best << 16) | best_d, (before << 16) | after, last, 0u);
    }
}
