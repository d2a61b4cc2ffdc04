// 3x3 median of the disparities, in the lower half of each word; confidence in the upper half stays. A pixel that is
// unknown stays so; an unknown neighbour votes as the centre does. An invocation makes four pixels of ROWS rows: their
// neighbours come with few loads.
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
    uint left;
    uvec4 here;
    uint right;
};
Row row_at(int y) {
    uvec4 words = words_at(y);
    return Row(beside(y, x - 1, words, true) & 0xffffu, words & 0xffffu, beside(y, x + 4, words, false) & 0xffffu);
}

uint vote(uint d, uint centre) { return d != 0u ? d : centre; }
// One pixel after the other, which takes fewer registers than four at once.
#define MEDIAN(l, m, r)                                                                                                 \
    (here.m == 0u ? 0u                                                                                                  \
                  : median9(vote(above.l, here.m), vote(above.m, here.m), vote(above.r, here.m), vote(here.l, here.m),  \
                            here.m, vote(here.r, here.m), vote(below.l, here.m), vote(below.m, here.m),                 \
                            vote(below.r, here.m)))

void main() {
    x = int(gl_GlobalInvocationID.x) * 4;
    int first_row = int(gl_GlobalInvocationID.y) * ROWS;
    if (x >= size.x || first_row >= size.y) return;
    Row above, here = row_at(first_row - 1), below = row_at(first_row);
    for (int y = first_row; y < min(first_row + ROWS, size.y); ++y) {
        above = here, here = below, below = row_at(y + 1);
        int at = (y * stride + x) >> 2;
        uvec4 confidence = disparity[at] & 0xffff0000u;
        uvec4 median;
        median.x = MEDIAN(left, here.x, here.y);
        median.y = MEDIAN(here.x, here.y, here.z);
        median.z = MEDIAN(here.y, here.z, here.w);
        median.w = MEDIAN(here.z, here.w, right);
        medians[at] = confidence | median;
    }
}
