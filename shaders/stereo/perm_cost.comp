// Matching cost of every pixel and disparity, a byte each in the order of perm_common.glsl, in a pass of its own. A lane
// computes four pixels of a row and half a slab (8 disparities). With ROW_PAIRS a row of costs stands for two rows of the
// pictures and a cost is the mean of both: the upper rows come first, and the lower rows in a second run.
#include "perm_common.glsl"

#ifndef ROW_PAIRS
#define ROW_PAIRS 0
#endif

layout(local_size_x = LANES) in;
layout(std430, binding = 0) readonly buffer LeftFeatures { uvec4 left_features[]; };
layout(std430, binding = 1) readonly buffer RightFeatures { uvec4 right_features[]; };
layout(std430, binding = 2) buffer Costs { uvec2 costs[]; };
uniform ivec2 size;  // of the costs
#if ROW_PAIRS
uniform int last_row;   // of the pictures
uniform bool is_lower;  // whether lower rows join the upper ones
#endif
uniform int stride;
uniform int plane;      // pixels of a slab of costs
uniform int first_row;  // of this run

// Before the picture its first column repeats.
uvec4 right_at(int row, int x) {
    uvec4 four = right_features[(row + max(x, 0)) >> 2];
    return x >= 0 ? four : four.xxxx;
}

// Right-hand words: word i is 8 columns before the first pixel's.
uvec4 r0, r1, r2;
#define R(i) ((i) < 4 ? r0 : (i) < 8 ? r1 : r2)[(i) & 3]
#define PAIR(l, i) (cost_of(l, R(i)) | (cost_of(l, R((i)-1)) << 16))
// Disparities 0 to 7 of a pixel whose left-hand word is l.
#define PIXEL(l, i) uvec2(PAIR(l, i) | (PAIR(l, (i)-4) << 8), PAIR(l, (i)-2) | (PAIR(l, (i)-6) << 8))

#if ROW_PAIRS
void leave(int at, uvec2 cost) {
    if (is_lower) cost = ((cost + costs[at] + 0x01010101u) >> 1) & 0x7f7f7f7fu;
    costs[at] = cost;
}
#else
void leave(int at, uvec2 cost) { costs[at] = cost; }
#endif

void main() {
    int x = int(gl_GlobalInvocationID.x >> 1) * 4, part = int(gl_GlobalInvocationID.x & 1u);
    int y = first_row + int(gl_GlobalInvocationID.y), slab = int(gl_GlobalInvocationID.z);
    if (x >= size.x || y >= size.y) return;
#if ROW_PAIRS
    int row = (is_lower ? min(2 * y + 1, last_row) : 2 * y) * stride;
#else
    int row = y * stride;
#endif
    int first = x - 16 * slab - 8 * part, at = (slab * plane + block_at(x, y, size.y)) * 2 + part;
    uvec4 l = left_features[(row + x) >> 2];
    r0 = right_at(row, first - 8);
    r1 = right_at(row, first - 4);
    r2 = right_at(row, first);
    leave(at, PIXEL(l.x, 8));
    leave(at + 2, PIXEL(l.y, 9));
    leave(at + 4, PIXEL(l.z, 10));
    leave(at + 6, PIXEL(l.w, 11));
}
