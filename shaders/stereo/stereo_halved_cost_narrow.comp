// The costs of stereo_halved_cost.comp, bit for bit, for GPUs with few registers per lane (Raspberry Pi's V3D).
// A lane computes two neighbouring pixels and half a slab (8 disparities). Lanes lie along the row, so that
// neighbouring lanes read neighbouring words. Right-hand words arrive four at a time, and only the cost of the
// previous odd column is kept. With BOTH, the upper right pixels of each 2x2 come first, and the lower left ones in a
// second run, which leaves the means.
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
layout(std430, binding = 2) buffer Costs { uvec2 costs[]; };
uniform ivec2 size;  // of the half-size grid
uniform ivec2 fine_size;
uniform int fine_stride;
uniform int plane;      // pixels of a slab of costs
uniform int first_row;  // of this run
#if BOTH
uniform bool is_lower;  // whether the lower left pixels join the upper right ones, in a second run
#else
const bool is_lower = false;
#endif

// Block `at` of four right-hand words of a row that begins at `row_blocks`. Before the picture its first column repeats.
uvec4 right_at(int row_blocks, int at) {
    uvec4 four = right_features[row_blocks + max(at, 0)];
    return at < 0 ? four.xxxx : four;
}

// Disparity j of four for both pixels; the byte that it goes to belongs to perm_common.glsl. The words at twice the
// disparity and one beyond it belong to j; the cost of the word one short of it comes from the step before.
#define BYTE(cost, at) (((cost) >> (26 - (at))) & (31u << (at)))
#define STEP(j, byte_at, even_a, odd_a, even_b, odd_b)                                                                \
    {                                                                                                                \
        uint next_a = upper_cost_of(a, odd_a), next_b = upper_cost_of(b, odd_b);                                     \
        sum[(j) / 2] += BYTE(min(min(previous_a, upper_cost_of(a, even_a)), next_a), byte_at + 16 * ((j) & 1));      \
        sum[2 + (j) / 2] += BYTE(min(min(previous_b, upper_cost_of(b, even_b)), next_b), byte_at + 16 * ((j) & 1));  \
        previous_a = next_a, previous_b = next_b;                                                                    \
    }

uvec4 block;  // the last one that was read of the right-hand row

// The next four words to the left. They start one column earlier in the lower row, whose left pixels do.
uvec4 next_four(int row_blocks, int at) {
    uvec4 to_the_right = block;
    block = right_at(row_blocks, at);
    return is_lower ? uvec4(block.w, to_the_right.xyz) : to_the_right;
}

// With BOTH a condition that is always true. It ends a block of code that the compiler puts into an order of its own, and
// so keeps the words of later steps out of the registers. Without BOTH they fit, and the condition would make them spill.
#if BOTH
#define IN_ORDER if (plane > 0)
#else
#define IN_ORDER
#endif

void main() {
    // A workgroup covers LANES rows of 4 * STEPS columns, one row after the other.
    int first_y = first_row + int(gl_WorkGroupID.x) * LANES, lane = int(gl_LocalInvocationID.x);
    int first_column = int(gl_WorkGroupID.y) * 4 * STEPS, slab = int(gl_WorkGroupID.z), part = lane & 1;
    // There is no disparity -1.
    uint before_first = slab + part == 0 ? 31u << 26 : 0u;
    int end_row = min(first_y + LANES, size.y), end = min(first_column + 4 * STEPS, size.x);
    int last = fine_stride - 1, shift = 32 * slab + 16 * part;
    for (int y = first_y; y < end_row; ++y) {
#if BOTH
        int row = (is_lower ? min(2 * y + 1, fine_size.y - 1) : 2 * y) * fine_stride;
#else
        // The upper row of a 2x2, the lower one of the next below.
        int row = min(2 * y + (y & 1), fine_size.y - 1) * fine_stride;
#endif
        int row_blocks = row >> 2;
        for (int x = first_column + (lane & ~1); x < end; x += LANES) {
            int left_column = is_lower ? 2 * x : 2 * x + 1, at_block = (2 * x - shift) >> 2;
            uint a = left_features[row + min(left_column, last)], b = left_features[row + min(left_column + 2, last)];
            // Columns from block `at_block` to the left for a, and two columns further right for b. Disparities 0 to 3, then 4
            // to 7.
            block = right_at(row_blocks, min(at_block + 1, last >> 2));
            uvec4 sum = uvec4(0u), w = next_four(row_blocks, at_block), v = next_four(row_blocks, at_block - 1);
            uint previous_a = max(upper_cost_of(a, v.z), before_first), previous_b = max(upper_cost_of(b, w.x), before_first);
            STEP(0, 0, v.y, v.x, v.w, v.z)
            w = v, v = next_four(row_blocks, at_block - 2);
            STEP(1, 0, v.w, v.z, w.y, w.x)
                STEP(2, 0, v.y, v.x, v.w, v.z)
                w = v, v = next_four(row_blocks, at_block - 3);
                STEP(3, 0, v.w, v.z, w.y, w.x)
            IN_ORDER {
                STEP(0, 8, v.y, v.x, v.w, v.z)
                w = v, v = next_four(row_blocks, at_block - 4);
                STEP(1, 8, v.w, v.z, w.y, w.x)
                STEP(2, 8, v.y, v.x, v.w, v.z)
                w = v, v = next_four(row_blocks, at_block - 5);
                STEP(3, 8, v.w, v.z, w.y, w.x)
            }
            int at = (slab * plane + block_at(x, y, size.y)) * 2 + part;
#if BOTH
            if (is_lower) sum = ((sum + uvec4(costs[at], costs[at + 2]) + 0x01010101u) >> 1) & 0x7f7f7f7fu;
#endif
            costs[at] = sum.xy;
            costs[at + 2] = sum.zw;
        }
    }
}
