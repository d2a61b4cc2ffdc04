// Vertical permeability aggregation of one slab, then winner takes all. An invocation walks a column down and back
// up, four rows a step. Going down it leaves only what comes to each group of four; going up it makes the group's sums
// from that again, which costs less than to write and read them all. On the way up the sums are complete, and the best disparity so far is kept for every pixel with its two
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
layout(std430, binding = 0) readonly buffer Permeability { uint permeability[]; };  // a byte each of four rows
layout(std430, binding = 1) readonly buffer Volume { uvec4 volume[]; };
layout(std430, binding = 2) buffer Marks { uvec4 marks[]; };  // the sums from above a group of rows
#if KEEP
layout(std430, binding = 3) writeonly buffer Costs { uvec4 costs[]; };  // a byte each, slab after slab
layout(std430, binding = 4) readonly buffer Scale { uint scale[]; };  // 16 bits each, two pixels a word
uniform int plane;  // pixels of a slab of costs
#else
layout(std430, binding = 3) buffer Winners { uvec2 winners[]; };  // see winner_takes_all.glsl
#endif
uniform ivec2 size;
uniform int stride;
uniform int first_disparity;

const int group_rows = 4;

#if KEEP
// Sums shifted to 8 bits times a factor of the pixel, see perm_weight.comp, in pairs; then four bytes a word.
uvec2 codes_of(uvec4 sums, uint scale) {
    uvec4 codes = ((((sums >> (scale >> 13)) & low_bytes) * (scale & 0x1fffu)) >> 8) & low_bytes;
    codes = (codes | (codes >> 8)) & 0xffffu;
    return codes.xz | (codes.yw << 16);
}
#endif

// The rows of a group, from the sums that come down to it. What lies below the picture passes nothing on.
#define ROW_OF(k) (first + (k))
#define DOWN(k)                                                                        \
    {                                                                                  \
        int y = min(ROW_OF(k), size.y - 1);                                            \
        uint mu = (four >> (8 * (k))) & 255u;                                          \
        uvec4 sums = volume[column + y * block_px];                                    \
        a = pairs_of(sums.xy) + permeate(a, mu);                                       \
        b = pairs_of(sums.zw) + permeate(b, mu);                                       \
    }
#define DOWN_AGAIN(k, mu, own, sum_a, sum_b)                                           \
    {                                                                                  \
        int y = min(ROW_OF(k), size.y - 1);                                            \
        mu = (four >> (8 * (k))) & 255u;                                               \
        own = volume[column + y * block_px];                                           \
        sum_a = a = pairs_of(own.xy) + permeate(a, mu);                                \
        sum_b = b = pairs_of(own.zw) + permeate(b, mu);                                \
    }
#define UP(k, mu, own, sum_a, sum_b)                                                   \
    if (ROW_OF(k) < size.y) leave(ROW_OF(k), x, column, sum_a + up_a, sum_b + up_b);   \
    up_a = permeate(up_a + pairs_of(own.xy), mu);                                      \
    up_b = permeate(up_b + pairs_of(own.zw), mu);

void leave(int y, int x, int column, uvec4 sum_a, uvec4 sum_b) {
    int at = column + y * block_px;
#if KEEP
    uint by = (scale[(y * stride + x) >> 1] >> (16 * (x & 1))) & 0xffffu;
    costs[(first_disparity >> 4) * plane + at] = whole(uvec4(codes_of(sum_a, by), codes_of(sum_b, by)));
#else
    no_winner_yet();
    if (first_disparity > 0) resume_winner(winners[at]);
    consider_slab(first_disparity, sum_a, sum_b, VALID);
    winners[at] = whole(winner());
#endif
}

void main() {
    int x = int(gl_GlobalInvocationID.x);
    if (x >= size.x) return;
    int column = block_at(x, 0, size.y), groups = (size.y + group_rows - 1) / group_rows;

    uvec4 a = uvec4(0u), b = uvec4(0u);
    for (int group = 0; group < groups; ++group) {
        int first = group * group_rows, mark = block_at(x, group, groups) * 2;
        uint four = permeability[group * stride + x];
        marks[mark] = a;
        marks[mark + 1] = b;
        DOWN(0) DOWN(1) DOWN(2) DOWN(3)
    }

    uvec4 up_a = uvec4(0u), up_b = uvec4(0u);
    for (int group = groups - 1; group >= 0; --group) {
        int first = group * group_rows, mark = block_at(x, group, groups) * 2;
        uint four = permeability[group * stride + x];
        a = marks[mark];
        b = marks[mark + 1];
        uint mu0, mu1, mu2, mu3;
        uvec4 own0, own1, own2, own3, a0, a1, a2, a3, b0, b1, b2, b3;
        DOWN_AGAIN(0, mu0, own0, a0, b0) DOWN_AGAIN(1, mu1, own1, a1, b1)
        DOWN_AGAIN(2, mu2, own2, a2, b2) DOWN_AGAIN(3, mu3, own3, a3, b3)
        UP(3, mu3, own3, a3, b3) UP(2, mu2, own2, a2, b2) UP(1, mu1, own1, a1, b1) UP(0, mu0, own0, a0, b0)
    }
}
