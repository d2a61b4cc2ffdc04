// The costs of stereo_halved_cost.comp, bit for bit, for GPUs with few registers per lane (Raspberry Pi's V3D).
// A lane computes two neighbouring pixels and half a slab (8 disparities). Lanes lie along the row, so that
// neighbouring lanes read neighbouring words. Right-hand words arrive four at a time, and only the cost of the
// previous odd column is kept. With BOTH, the upper and the lower row of each 2x2 run through the same loop body,
// which keeps the program small enough for the instruction cache.
#define LANE_MAPPING 1  // LANES_DISPARITIES
#include "perm_common.glsl"

#ifndef BOTH
#define BOTH 1
#endif
#ifndef STEPS
#define STEPS 16
#endif

layout(local_size_x = LANES) in;
layout(std430, binding = 0) readonly buffer LeftFeatures { uint left_features[]; };
layout(std430, binding = 1) readonly buffer RightFeatures { uvec4 right_features[]; };
layout(std430, binding = 2) writeonly buffer Costs { uvec2 costs[]; };
uniform ivec2 size;  // of the half-size grid
uniform ivec2 fine_size;
uniform int fine_stride;
uniform int plane;  // pixels of a slab of costs

// Four right-hand words from a column that is a multiple of four. Before the picture its first column repeats.
uvec4 right_at(int row, int column) {
    uvec4 four = right_features[(row + clamp(column, 0, fine_stride - 4)) >> 2];
    return column < 0 ? four.xxxx : four;
}

// Disparity j of four for both pixels; the byte that it goes to belongs to perm_common.glsl. The words at twice the
// disparity and one beyond it belong to j; the cost of the word one short of it comes from the step before.
#define STEP(j, byte_at, even_a, odd_a, even_b, odd_b)                                                                \
    {                                                                                                        \
        uint next_a = cost_of(a, odd_a), next_b = cost_of(b, odd_b);                                         \
        sum[(j) / 2] |= min(min(previous_a, cost_of(a, even_a)), next_a) << (byte_at + 16 * ((j) & 1));      \
        sum[2 + (j) / 2] |= min(min(previous_b, cost_of(b, even_b)), next_b) << (byte_at + 16 * ((j) & 1));  \
        previous_a = next_a, previous_b = next_b;                                                            \
    }

uvec4 block;  // the last one that was read of the right-hand row

// The next four words to the left. They start one column earlier in the lower row, whose left pixels do.
uvec4 next_four(int row, int column, bool is_upper) {
    uvec4 to_the_right = block;
    block = right_at(row, column);
#if BOTH
    return is_upper ? to_the_right : uvec4(block.w, to_the_right.xyz);
#else
    return to_the_right;
#endif
}

// Costs of left-hand word a against columns from `column` to the left, and of b two columns further right. Disparities 0
// to 3, then 4 to 7.
uvec4 costs_of(int row, int column, uint a, uint b, uint before_first, bool is_upper) {
    block = right_at(row, column + 4);
    uvec4 sum = uvec4(0u), w = next_four(row, column, is_upper), v = next_four(row, column - 4, is_upper);
    uint previous_a = max(cost_of(a, v.z), before_first), previous_b = max(cost_of(b, w.x), before_first);
    STEP(0, 0, v.y, v.x, v.w, v.z)
    w = v, v = next_four(row, column - 8, is_upper);
    STEP(1, 0, v.w, v.z, w.y, w.x)
    STEP(2, 0, v.y, v.x, v.w, v.z)
    w = v, v = next_four(row, column - 12, is_upper);
    STEP(3, 0, v.w, v.z, w.y, w.x)
    STEP(0, 8, v.y, v.x, v.w, v.z)
    w = v, v = next_four(row, column - 16, is_upper);
    STEP(1, 8, v.w, v.z, w.y, w.x)
    STEP(2, 8, v.y, v.x, v.w, v.z)
    w = v, v = next_four(row, column - 20, is_upper);
    STEP(3, 8, v.w, v.z, w.y, w.x)
    return sum;
}

void main() {
    // A workgroup covers LANES rows of 4 * STEPS columns, one row after the other.
    int first_row = int(gl_WorkGroupID.x) * LANES, lane = int(gl_LocalInvocationID.x);
    int first_column = int(gl_WorkGroupID.y) * 4 * STEPS, slab = int(gl_WorkGroupID.z), part = lane & 1;
    // There is no disparity -1.
    uint before_first = slab + part == 0 ? 31u : 0u;
    int end_row = min(first_row + LANES, size.y), end = min(first_column + 4 * STEPS, size.x);
    int last = fine_stride - 1, shift = 32 * slab + 16 * part;
    for (int y = first_row; y < end_row; ++y) {
        for (int x = first_column + (lane & ~1); x < end; x += LANES) {
            int row = 2 * y * fine_stride;
#if BOTH
            uvec4 sum = uvec4(0u);
            int rows = 2 + min(plane, 0);  // 2, and a loop that the compiler does not unroll
            for (int i = 0; i < rows; ++i) {
                bool is_upper = i == 0;
                int column = 2 * x + 1 - i;
                sum += costs_of(row, 2 * x - shift, left_features[row + min(column, last)],
                                left_features[row + min(column + 2, last)], before_first, is_upper);
                row = min(2 * y + 1, fine_size.y - 1) * fine_stride;
            }
            sum = ((sum + 0x01010101u) >> 1) & 0x7f7f7f7fu;
#else
            uvec4 sum = costs_of(row, 2 * x - shift, left_features[row + min(2 * x + 1, last)],
                                 left_features[row + min(2 * x + 3, last)], before_first, true);
#endif
            int at = (slab * plane + block_at(x, y, size.y)) * 2 + part;
            costs[at] = sum.xy;
            costs[at + 2] = sum.zw;
        }
    }
}
