// Vertical permeability aggregation of one slab, then winner takes all. An invocation walks a column down and back
// up; on the way up the sums are complete, and the best disparity so far is kept for every pixel with its two
// neighbours' costs (for sub-pixel positions), so that slabs follow one another through the same small volume.
#include "perm_common.glsl"
#include "winner_takes_all.glsl"

// Disparities of this slab that count, 1..16.
#ifndef VALID
#define VALID 16
#endif
// 1: leaves a cost of a byte for every disparity, the sum divided by the pixel's weight, for passes that follow; in
// place of winners.
#ifndef KEEP
#define KEEP 0
#endif

layout(local_size_x = LANES) in;
layout(std430, binding = 0) readonly buffer Permeability { uint permeability[]; };
layout(std430, binding = 1) readonly buffer Volume { uvec4 volume[]; };
layout(std430, binding = 2) buffer Down { uvec4 down[]; };
#if KEEP
layout(std430, binding = 3) writeonly buffer Costs { uvec4 costs[]; };  // a byte each, slab after slab
layout(std430, binding = 4) readonly buffer Scale { uint scale[]; };
uniform int plane;  // pixels of a slab of costs
#else
layout(std430, binding = 3) buffer Winners { uvec2 winners[]; };  // see winner_takes_all.glsl
#endif
uniform ivec2 size;
uniform int stride;
uniform int first_disparity;

#if KEEP
// Sums shifted to 8 bits times a factor of the pixel, see perm_weight.comp, in pairs; then four bytes a word.
uvec2 codes_of(uvec4 sums, uint scale) {
    uvec4 codes = ((((sums >> (scale >> 16)) & low_bytes) * (scale & 0xffffu)) >> 8) & low_bytes;
    codes = (codes | (codes >> 8)) & 0xffffu;
    return codes.xz | (codes.yw << 16);
}
#endif

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

#if KEEP
        uint by = scale[y * stride + x];
        costs[(first_disparity >> 4) * plane + at] = uvec4(codes_of(sum_a, by), codes_of(sum_b, by));
#else
        no_winner_yet();
        if (first_disparity > 0) resume_winner(winners[at]);
        consider_slab(first_disparity, sum_a, sum_b, VALID);
        winners[at] = winner();
#endif
    }
}
