// Leaves only the disparities that enough of the 25 pixels at every second place around them share: what is found in
// an occluded stripe by chance stands alone, and a fill would spread it. Beyond the edges the picture repeats. An
// invocation makes four pixels of ROWS rows.
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

int x;

// Disparities of four pixels of a row, those beyond the row's last pixel repeating it.
ivec4 known_at(int row, int column) {
    uvec4 words = disparity[(row + column) >> 2] & 0xffffu;
    int count = size.x - column;
    if (count < 4) words = uvec4(words.x, count < 2 ? uvec3(words.x) : count < 3 ? words.yyy : words.yzz);
    ivec4 d = ivec4(words);
    return d + (ivec4(equal(d, ivec4(0))) << 20);  // the unknown are far from everything
}

// Columns x - 4 .. x + 7 of a row.
struct Row {
    ivec4 before, here, after;
};
Row row_at(int y) {
    int row = clamp(y, 0, size.y - 1) * stride;
    ivec4 here = known_at(row, x);
    return Row(x > 0 ? known_at(row, x - 4) : here.xxxx, here,
               x + 4 < size.x ? known_at(row, x + 4) : here.wwww);
}

ivec4 vote(ivec4 centre, ivec4 d) { return ivec4(lessThanEqual(abs(d - centre), ivec4(32))); }
ivec4 votes_of(ivec4 centre, Row r) {
    return vote(centre, r.before) + vote(centre, ivec4(r.before.zw, r.here.xy)) + vote(centre, r.here) +
           vote(centre, ivec4(r.here.zw, r.after.xy)) + vote(centre, r.after);
}

void main() {
    x = int(gl_GlobalInvocationID.x) * 4;
    int first_row = int(gl_GlobalInvocationID.y) * ROWS;
    if (x >= size.x || first_row >= size.y) return;
    Row a, b = row_at(first_row - 4), c = row_at(first_row - 3), d = row_at(first_row - 2), e = row_at(first_row - 1);
    Row f = row_at(first_row), g = row_at(first_row + 1), h = row_at(first_row + 2), i = row_at(first_row + 3);
    for (int y = first_row; y < min(first_row + ROWS, size.y); ++y) {
        a = b, b = c, c = d, d = e, e = f, f = g, g = h, h = i;
        i = row_at(y + 4);
        ivec4 votes = votes_of(e.here, a) + votes_of(e.here, c) + votes_of(e.here, e) + votes_of(e.here, g) +
                      votes_of(e.here, i);
        uvec4 holds = uvec4(greaterThanEqual(votes, ivec4(LEAST_VOTES))) *
                      uvec4(lessThan(e.here, ivec4(65536)));
        int at = (y * stride + x) >> 2;
        supported[at] = disparity[at] * holds;
    }
}
