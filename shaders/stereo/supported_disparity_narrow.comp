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

// Disparities of four pixels of a row, those beyond the row's last pixel repeating it.
ivec4 known_at(int row, int column) {
    uvec4 words = disparity[(row + column) >> 2] & 0xffffu;
    int count = size.x - column;
    if (count < 4) words = uvec4(words.x, count < 2 ? uvec3(words.x) : count < 3 ? words.yyy : words.yzz);
    ivec4 d = ivec4(words);
    return d + (ivec4(equal(d, ivec4(0))) << 20);  // the unknown are far from everything
}

ivec4 is_near(ivec4 centre, ivec4 d) { return ivec4(lessThanEqual(abs(d - centre), ivec4(32))); }

void main() {
    int x = int(gl_GlobalInvocationID.x) * 4, first_row = int(gl_GlobalInvocationID.y) * ROWS;
    if (x >= size.x || first_row >= size.y) return;
    int before_x = max(x - 4, 0), after_x = x + 4 < size.x ? x + 4 : x;
    int reach = 4 + min(stride, 0);  // 4, and a loop that the compiler does not unroll
    for (int y = first_row; y < min(first_row + ROWS, size.y); ++y) {
        ivec4 centre = known_at(y * stride, x), support = ivec4(0);
        for (int dy = -reach; dy <= reach; dy += 2) {
            int row = clamp(y + dy, 0, size.y - 1) * stride;
            ivec4 here = known_at(row, x), before = known_at(row, before_x), after = known_at(row, after_x);
            if (x == 0) before = here.xxxx;
            if (after_x == x) after = here.wwww;
            support += is_near(centre, before) + is_near(centre, ivec4(before.zw, here.xy)) + is_near(centre, here) +
                       is_near(centre, ivec4(here.zw, after.xy)) + is_near(centre, after);
        }
        uvec4 holds = uvec4(greaterThanEqual(support, ivec4(LEAST_VOTES))) * uvec4(lessThan(centre, ivec4(65536)));
        int at = (y * stride + x) >> 2;
        supported[at] = disparity[at] * holds;
    }
}
