// Sub-pixel noise of disparities out of slanted surfaces: a mean over RADIUS pixels to both sides along rows
// (ALONG 0) or columns (1), of pairs that lie opposite to each other and are both known and within MOST_STEP of the
// disparity between them. A plane is its own mean, however slanted, and beside an edge there are no such pairs. A
// pair that does not count votes as the centre does. An invocation makes four pixels of ROWS rows.
#include "stereo_common.glsl"

#ifndef ALONG
#define ALONG 0
#endif
#ifndef MOST_STEP
#define MOST_STEP 32  // 1/32 px
#endif
#ifndef ROWS
#define ROWS 8
#endif

layout(local_size_x = PICTURE_LANES) in;
layout(std430, binding = 0) readonly buffer Disparity { uvec4 disparity[]; };  // uint a pixel: 1/32 px | confidence << 16
layout(std430, binding = 1) writeonly buffer Smoothed { uvec4 smoothed[]; };
uniform ivec2 size;
uniform int stride;

ivec4 known(uvec4 words) {
    ivec4 d = ivec4(words & 0xffffu);
    return d + (ivec4(equal(d, ivec4(0))) << 20);  // the unknown are far from everything
}

// How far two opposite pixels together lie from the one between them.
ivec4 pair(ivec4 here, ivec4 a, ivec4 b) {
    ivec4 from = a - here, to = b - here;
    ivec4 near = ivec4(lessThanEqual(max(abs(from), abs(to)), ivec4(MOST_STEP)));
    return near * (from + to);
}

// The sum's ninth, rounded, added to the disparity.
uvec4 moved(uvec4 words, ivec4 here, ivec4 sum) {
    ivec4 d = max(here + ((sum * 7282 + 32768) >> 16), ivec4(1));
    uvec4 is_known = uvec4(lessThan(here, ivec4(65536)));
    return (words & 0xffff0000u) | (uvec4(d) & 0xffffu) * is_known;
}

#if ALONG == 0
uvec4 words_at(int row, int x) { return disparity[(row + x) >> 2]; }

void main() {
    int x = int(gl_GlobalInvocationID.x) * 4, first_row = int(gl_GlobalInvocationID.y) * ROWS;
    if (x >= size.x) return;
    for (int y = first_row; y < min(first_row + ROWS, size.y); ++y) {
        int row = y * stride;
        uvec4 words = words_at(row, x);
        ivec4 here = known(words);
        // Pairs that reach over an end of the row do not count.
        ivec4 before = x > 0 ? known(words_at(row, x - 4)) : ivec4(1 << 20);
        ivec4 after = x + 4 < size.x ? known(words_at(row, x + 4)) : ivec4(1 << 20);
        if (x + 8 > size.x) {
            ivec4 column = ivec4(x + 4, x + 5, x + 6, x + 7);
            after += ivec4(greaterThanEqual(column, ivec4(size.x))) << 20;
            here += ivec4(greaterThanEqual(column - 4, ivec4(size.x))) << 20;
        }
        ivec4 sum = pair(here, ivec4(before.w, here.xyz), ivec4(here.yzw, after.x)) +
                    pair(here, ivec4(before.zw, here.xy), ivec4(here.zw, after.xy)) +
                    pair(here, ivec4(before.yzw, here.x), ivec4(here.w, after.xyz)) +
                    pair(here, before, after);
        smoothed[(row + x) >> 2] = moved(words, here, sum);
    }
}
#elif LANE_MAPPING == LANES_DISPARITIES
// For GPUs with few registers per lane: nothing slides from row to row, and rows are read again from the cache.
uvec4 words_at(int x, int y) { return disparity[(y * stride + x) >> 2]; }

void main() {
    int x = int(gl_GlobalInvocationID.x) * 4, first_row = int(gl_GlobalInvocationID.y) * ROWS;
    if (x >= size.x || first_row >= size.y) return;
    int reach = 4 + min(stride, 0);  // 4, and a loop that the compiler does not unroll
    for (int y = first_row; y < min(first_row + ROWS, size.y); ++y) {
        uvec4 words = words_at(x, y);
        ivec4 here = known(words), sum = ivec4(0);
        // Pairs that reach over an end of the column do not count.
        int last = min(reach, min(y, size.y - 1 - y));
        for (int k = 1; k <= last; ++k) sum += pair(here, known(words_at(x, y - k)), known(words_at(x, y + k)));
        smoothed[(y * stride + x) >> 2] = moved(words, here, sum);
    }
}
#else
uvec4 words_at(int x, int y) { return disparity[(y * stride + x) >> 2]; }
ivec4 row_at(int x, int y) {
    ivec4 d = known(words_at(x, clamp(y, 0, size.y - 1)));
    return y >= 0 && y < size.y ? d : ivec4(1 << 20);
}

void main() {
    int x = int(gl_GlobalInvocationID.x) * 4, first_row = int(gl_GlobalInvocationID.y) * ROWS;
    if (x >= size.x || first_row >= size.y) return;
    ivec4 a, b = row_at(x, first_row - 4), c = row_at(x, first_row - 3), d = row_at(x, first_row - 2);
    ivec4 e = row_at(x, first_row - 1), f = row_at(x, first_row), g = row_at(x, first_row + 1);
    ivec4 h = row_at(x, first_row + 2), i = row_at(x, first_row + 3);
    for (int y = first_row; y < min(first_row + ROWS, size.y); ++y) {
        a = b, b = c, c = d, d = e, e = f, f = g, g = h, h = i;
        i = row_at(x, y + 4);
        ivec4 sum = pair(e, d, f) + pair(e, c, g) + pair(e, b, h) + pair(e, a, i);
        smoothed[(y * stride + x) >> 2] = moved(words_at(x, y), e, sum);
    }
}
#endif
