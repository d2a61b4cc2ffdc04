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
layout(std430, binding = 1) readonly buffer Volume { uvec4 volume[]; };
layout(std430, binding = 2) buffer Down { uvec4 down[]; };
// x: cost << 20 | disparity << 12 | cost of the last disparity seen; y: cost of the disparity before the best << 12 |
// of the one after (0xfff: there is none).
layout(std430, binding = 3) buffer Winners { uvec2 winners[]; };
uniform ivec2 size;
uniform int stride;
uniform int first_disparity;

// The least of the 16 costs with its index below it: two costs a word, so that a minimum of words is one of the upper
// halves.
#define CONSIDER(k, w)                                                \
    {                                                                 \
        uint keys = (w << 4) | (uint(2 * k) | (uint(2 * k + 1) << 16)); \
        if (2 * k < VALID) least_low = min(least_low, keys << 16);    \
        if (2 * k + 1 < VALID) least_high = min(least_high, keys);    \
    }
uint least_of(uvec4 a, uvec4 b) {
    uint least_low = ~0u, least_high = ~0u;
    CONSIDER(0, a.x) CONSIDER(1, a.y) CONSIDER(2, a.z) CONSIDER(3, a.w)
    CONSIDER(4, b.x) CONSIDER(5, b.y) CONSIDER(6, b.z) CONSIDER(7, b.w)
    return min(least_low >> 16, least_high >> 16);
}

uint cost_at(uint i, uvec4 a, uvec4 b) {
    uvec4 four = (i & 8u) != 0u ? b : a;
    uvec2 two = (i & 4u) != 0u ? four.zw : four.xy;
    uint one = (i & 2u) != 0u ? two.y : two.x;
    return (i & 1u) != 0u ? one >> 16 : one & 0xffffu;
}

void main() {
    int x = int(gl_GlobalInvocationID.x);
    if (x >= size.x) return;

    uvec4 a = uvec4(0u), b = uvec4(0u);
    int at = block_at(x, 0, size.y);
    for (int y = 0; y < size.y; ++y, at += block_px) {
        uint mu = permeability[y * stride + x] >> 4;
        uvec4 sums = volume[at];
        a = pairs_of(sums.xy) + permeate(a, mu);
        b = pairs_of(sums.zw) + permeate(b, mu);
        down[at * 2] = a;
        down[at * 2 + 1] = b;
    }

    uvec4 down_a = a, down_b = b;
    a = b = uvec4(0u);  // now what comes from below
    for (int y = size.y - 1; y >= 0; --y) {
        at -= block_px;
        uint mu = permeability[y * stride + x] >> 4;
        uvec4 sum_a = down_a + a, sum_b = down_b + b;
        // A row's own sums are what the way down added there: no need to fetch them again.
        int above = max(at - block_px, 0);
        uvec4 above_a = down[above * 2], above_b = down[above * 2 + 1];
        a = permeate(a + down_a - permeate(above_a, mu), mu);
        b = permeate(b + down_b - permeate(above_b, mu), mu);
        down_a = above_a;
        down_b = above_b;

        uint best = 0xfffu, best_d = 0xffu, before = 0xfffu, after = 0xfffu, last = 0xfffu;
        if (first_disparity > 0) {
            uvec2 state = winners[at];
            best = state.x >> 20;
            best_d = (state.x >> 12) & 255u;
            last = state.x & 0xfffu;
            before = state.y >> 12;
            after = best_d + 1u == uint(first_disparity) ? sum_a.x & 0xffffu : state.y & 0xfffu;
        }
        uint least = least_of(sum_a, sum_b), i = least & 15u;
        if ((least >> 4) < best) {
            best = least >> 4;
            best_d = uint(first_disparity) + i;
            before = i == 0u ? last : cost_at(i - 1u, sum_a, sum_b);
            after = i == uint(VALID - 1) ? 0xfffu : cost_at(i + 1u, sum_a, sum_b);
        }
        last = sum_b.w >> 16;
        winners[at] = uvec2((best << 20) | (best_d << 12) | last, (before << 12) | after);
    }
}
