// 3x3 median of the disparities, in the lower half of each word; confidence in the upper half stays. A pixel that is
// unknown stays so; an unknown neighbour votes as the centre does. An invocation makes four pixels of ROWS rows: their
// neighbours come with few loads.
#define MEDIAN_OF uvec4
#include "stereo_common.glsl"
#include "stereo_median9.glsl"

#ifndef ROWS
#define ROWS 8
#endif

layout(local_size_x = PICTURE_LANES) in;
layout(std430, binding = 0) readonly buffer Disparity { uvec4 disparity[]; };  // uint a pixel: 1/32 px | confidence << 16
layout(std430, binding = 1) writeonly buffer Medians { uvec4 medians[]; };
uniform ivec2 size;
uniform int stride;

int x;

uvec4 words_at(int y) {
    uvec4 words = disparity[(clamp(y, 0, size.y - 1) * stride + x) >> 2];
    // Behind the picture its last column repeats.
    int count = size.x - x;
    if (count < 2) words.y = words.x;
    if (count < 3) words.z = words.y;
    if (count < 4) words.w = words.z;
    return words;
}
uint beside(int y, int column, uvec4 words, bool left) {
    if (left ? column < 0 : column >= size.x) return left ? words.x : words.w;
    return disparity[(clamp(y, 0, size.y - 1) * stride + column) >> 2][column & 3];
}

// A row's disparities of columns x - 1 .. x + 4.
struct Row {
    uvec4 before, here, after;
};
Row row_at(int y) {
    uvec4 words = words_at(y);
    uint left = beside(y, x - 1, words, true), right = beside(y, x + 4, words, false);
    return Row(uvec4(left, words.xyz) & 0xffffu, words & 0xffffu, uvec4(words.yzw, right) & 0xffffu);
}

uvec4 votes(uvec4 d, uvec4 centre) { return d + centre * uvec4(equal(d, uvec4(0u))); }

void main() {
    x = int(gl_GlobalInvocationID.x) * 4;
    int first_row = int(gl_GlobalInvocationID.y) * ROWS;
    if (x >= size.x || first_row >= size.y) return;
    Row above, here = row_at(first_row - 1), below = row_at(first_row);
    for (int y = first_row; y < min(first_row + ROWS, size.y); ++y) {
        above = here, here = below, below = row_at(y + 1);
        uvec4 centre = here.here;
        uvec4 p0 = votes(above.before, centre), p1 = votes(above.here, centre), p2 = votes(above.after, centre);
        uvec4 p3 = votes(here.before, centre), p4 = centre, p5 = votes(here.after, centre);
        uvec4 p6 = votes(below.before, centre), p7 = votes(below.here, centre), p8 = votes(below.after, centre);
        int at = (y * stride + x) >> 2;
        uvec4 known = uvec4(notEqual(centre, uvec4(0u)));
        medians[at] = (disparity[at] & 0xffff0000u) | median9(p0, p1, p2, p3, p4, p5, p6, p7, p8) * known;
    }
}
