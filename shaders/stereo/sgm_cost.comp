// Matching cost of 16 disparities for four pixels, a byte each, times SCALE, for path aggregation.
#include "perm_common.glsl"

#ifndef SCALE
#define SCALE 1
#endif

layout(local_size_x = PICTURE_LANES) in;
layout(std430, binding = 0) readonly buffer LeftFeatures { uvec4 left_features[]; };
layout(std430, binding = 1) readonly buffer RightFeatures { uvec4 right_features[]; };
layout(std430, binding = 2) writeonly buffer Costs { uvec4 costs[]; };
uniform ivec2 size;
uniform int stride;
uniform int plane;  // pixels of a slab of costs

uvec4 r0, r1, r2, r3, r4;
#define R(i) ((i) < 4 ? r0 : (i) < 8 ? r1 : (i) < 12 ? r2 : (i) < 16 ? r3 : r4)[(i) & 3]
#define FOUR(l, i)                                                                                    \
    uint(SCALE) * (cost_of(l, R(i)) | (cost_of(l, R((i)-1)) << 8) | (cost_of(l, R((i)-2)) << 16) | \
                   (cost_of(l, R((i)-3)) << 24))
#define PIXEL(l, pixel) \
    costs[at + pixel] = uvec4(FOUR(l, 16 + pixel), FOUR(l, 12 + pixel), FOUR(l, 8 + pixel), FOUR(l, 4 + pixel));

// Before the picture its first column repeats.
uvec4 right_at(int row, int x) {
    uvec4 four = right_features[(row + max(x, 0)) >> 2];
    return x >= 0 ? four : four.xxxx;
}

void main() {
    int x = int(gl_GlobalInvocationID.x) * 4, y = int(gl_GlobalInvocationID.y), slab = int(gl_GlobalInvocationID.z);
    if (x >= size.x || y >= size.y) return;
    int row = y * stride, first = x - 16 * slab;
    r0 = right_at(row, first - 16);
    r1 = right_at(row, first - 12);
    r2 = right_at(row, first - 8);
    r3 = right_at(row, first - 4);
    r4 = right_at(row, first);
    uvec4 l = left_features[(row + x) >> 2];
    int at = slab * plane + block_at(x, y, size.y);
    PIXEL(l.x, 0) PIXEL(l.y, 1) PIXEL(l.z, 2) PIXEL(l.w, 3)
}
