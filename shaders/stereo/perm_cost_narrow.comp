// Matching cost of every pixel and disparity, a byte each in the order of perm_common.glsl, for GPUs with few registers
// per lane (Raspberry Pi's V3D). A lane computes four pixels of a row and half a slab (8 disparities).
#define LANE_MAPPING 1  // LANES_DISPARITIES
#include "perm_common.glsl"

layout(local_size_x = LANES) in;
layout(std430, binding = 0) readonly buffer LeftFeatures { uvec4 left_features[]; };
layout(std430, binding = 1) readonly buffer RightFeatures { uvec4 right_features[]; };
layout(std430, binding = 2) writeonly buffer Costs { uvec2 costs[]; };
uniform ivec2 size;
uniform int stride;
uniform int plane;  // pixels of a slab of costs

// Before the picture its first column repeats.
uvec4 right_at(int row, int x) {
    uvec4 four = right_features[(row + max(x, 0)) >> 2];
    return x >= 0 ? four : four.xxxx;
}

// Right-hand words of four disparities: word i is 4 columns before the first pixel's.
uvec4 before, here;
#define R(i) ((i) < 4 ? before : here)[(i) & 3]
#define PAIR(l, i) (cost_of(l, R(i)) | (cost_of(l, R((i)-1)) << 16))
#define PIXEL(sum, l, pixel) sum |= uvec2(PAIR(l, 4 + pixel), PAIR(l, 2 + pixel)) << byte_at;

void main() {
    int x = int(gl_GlobalInvocationID.x >> 1) * 4, part = int(gl_GlobalInvocationID.x & 1u);
    int y = int(gl_GlobalInvocationID.y), slab = int(gl_GlobalInvocationID.z);
    if (x >= size.x || y >= size.y) return;
    int row = y * stride, first = x - 16 * slab - 8 * part;
    uvec4 l = left_features[(row + x) >> 2];
    uvec2 a = uvec2(0u), b = uvec2(0u), c = uvec2(0u), d = uvec2(0u);
    // Disparities 0 to 3, then 4 to 7.
    before = right_at(row, first);
    int end = 16 + min(plane, 0);  // 16, and a loop that the compiler does not unroll
    for (int byte_at = 0; byte_at < end; byte_at += 8) {
        here = before;
        first -= 4;
        before = right_at(row, first);
        PIXEL(a, l.x, 0) PIXEL(b, l.y, 1) PIXEL(c, l.z, 2) PIXEL(d, l.w, 3)
    }
    int at = (slab * plane + block_at(x, y, size.y)) * 2 + part;
    costs[at] = a;
    costs[at + 2] = b;
    costs[at + 4] = c;
    costs[at + 6] = d;
}
