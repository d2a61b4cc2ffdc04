// The result of supported_disparity.comp, bit for bit, for GPUs with few registers per lane (Raspberry Pi's V3D):
// nothing slides from row to row, and rows are read again from the cache. An invocation makes four pixels of ROWS rows.
#include "stereo_common.glsl"

#ifndef LEAST_VOTES
#define LEAST_VOTES 12
#endif
#ifndef ROWS
#define ROWS 8
#endif

layout(local_size_x = PICTURE_LANES) in;
layout(std430, binding = 0) readonly buffer Disparity { uvec4 disparity[]; };  // uint a pixel: 1/32 px | confidence << 16
layout(std430, binding = 1) writeonly buffer Supported { uvec4 supported[]; };
uniform ivec2 size;
uniform int stride;

// Two disparities a word, 16 bits each, less one. The unknown are far from everything: disparities lie below 0x2000.
const uint high = 0x80008000u, ones = 0x00010001u, unknown = 0x5fffu;

// Disparities of four pixels of a row, those beyond the row's last pixel repeating it.
uvec2 known_at(int row, int column) {
    uvec4 words = disparity[(row + column) >> 2];
    uvec2 pairs = ((((words.xz & 0xffffu) | (words.yw << 16)) | high) - ones) & (unknown * ones);
    int count = size.x - column;
    if (count < 4) {
        if (count < 2) pairs.x = (pairs.x & 0xffffu) * ones;
        pairs.y = count < 3 ? (pairs.x >> 16) * ones : (pairs.y & 0xffffu) * ones;
    }
    return pairs;
}

// 1 for each of two disparities that lie within 32 of a centre, by which `above` begins 32 higher and `below` 32 lower.
uvec2 is_near(uvec2 below, uvec2 above, uvec2 d) { return ((d + below) & (above - d) & high) >> 15; }

void main() {
    int x = int(gl_GlobalInvocationID.x) * 4, first_row = int(gl_GlobalInvocationID.y) * ROWS;
    if (x >= size.x || first_row >= size.y) return;
    int before_x = max(x - 4, 0), after_x = x + 4 < size.x ? x + 4 : x;
    int reach = 4 + min(stride, 0);  // 4, and a loop that the compiler does not unroll
    for (int y = first_row; y < min(first_row + ROWS, size.y); ++y) {
        uvec2 centre = known_at(y * stride, x), support = uvec2(0u);
        uvec2 below = (high | (32u * ones)) - centre, above = (high | (32u * ones)) + centre;
        for (int dy = -reach; dy <= reach; dy += 2) {
            int row = clamp(y + dy, 0, size.y - 1) * stride;
            uvec2 here = known_at(row, x), before = known_at(row, before_x), after = known_at(row, after_x);
            if (x == 0) before = uvec2((here.x & 0xffffu) * ones);
            if (after_x == x) after = uvec2((here.y >> 16) * ones);
            support += is_near(below, above, before) + is_near(below, above, uvec2(before.y, here.x)) +
                       is_near(below, above, here) + is_near(below, above, uvec2(here.y, after.x)) +
                       is_near(below, above, after);
        }
        uvec2 holds = (support + uint(0x8000 - LEAST_VOTES) * ones) & (high + (unknown - 1u) * ones - centre) & high;
        int at = (y * stride + x) >> 2;
        supported[at] = disparity[at] * uvec4((holds.x >> 15) & 1u, holds.x >> 31, (holds.y >> 15) & 1u, holds.y >> 31);
    }
}
