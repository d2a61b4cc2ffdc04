// Twice the size. Where a coarse pixel's four neighbours are all near it, disparity lies on the plane through them.
// Else each pixel takes the disparity of that one of the five which is near and looks most like it, so that depth edges
// move to where they are. One invocation four coarse pixels, 8x2 results.
#include "stereo_common.glsl"

#ifndef CONFIDENCE
#define CONFIDENCE 1  // 0: results are disparities of 16 bits, without confidence
#endif

layout(local_size_x = PICTURE_LANES) in;
layout(std430, binding = 0) readonly buffer CoarseDisparity { uvec4 coarse_disparity[]; };
layout(std430, binding = 1) readonly buffer CoarseLuma { uint coarse_luma[]; };
layout(std430, binding = 2) readonly buffer FineLuma { uint fine_luma[]; };
#if CONFIDENCE
layout(std430, binding = 3) writeonly buffer FineDisparity { uvec4 fine_disparity[]; };
void leave(int at, uvec4 words) { fine_disparity[at] = words; }
#else
layout(std430, binding = 3) writeonly buffer FineDisparity { uvec2 fine_disparity[]; };
void leave(int at, uvec4 words) { fine_disparity[at] = whole(words.xz | (words.yw << 16)); }
#endif
uniform ivec2 coarse_size;
uniform int coarse_stride;
uniform int coarse_row_words;
uniform ivec2 fine_size;
uniform int fine_stride;
uniform int fine_row_words;

const int most_step = 16;  // 1/32 coarse px

// A coarse pixel and its neighbours: disparity | confidence << 16, and luma.
struct Cross {
    uint here, left, right, above, below;
    int luma_here, luma_left, luma_right, luma_above, luma_below;
};

// A candidate is as unlike as it is far (in quarters of a coarse pixel) and looks different.
#define TRY(d, l, far)                          \
    {                                           \
        int cost = abs(luma - (l)) + (far);   \
        if (cost < least) best = (d);         \
        least = min(least, cost);             \
    }
uint chosen(Cross c, int luma, int i, int j) {
    int left_far = i == 0 ? 4 : 6, right_far = 10 - left_far, above_far = j == 0 ? 4 : 6, below_far = 10 - above_far;
    int least = 1 << 20;
    uint best = 0u;
    TRY(c.here, c.luma_here, 2)
    TRY(c.above, c.luma_above, above_far)
    TRY(c.below, c.luma_below, below_far)
    TRY(c.left, c.luma_left, left_far)
    TRY(c.right, c.luma_right, right_far)
#if CONFIDENCE
    return (best & 0xffff0000u) | ((best & 0xffffu) << 1);
#else
    return (best & 0x7fffu) << 1;
#endif
}

int value(uint word) { return int(word & 0xffffu); }
bool is_near(uint here, uint there) {
    return (there & 0xffffu) != 0u && abs(value(there) - value(here)) <= most_step;
}
// The plane at a quarter of a pixel to the sides of `beside` and `beyond`.
uint on_plane(uint here, uint beside, uint beyond) {
    uint disparity = uint((2 * value(here) + value(beside) + value(beyond) + 1) >> 1);
#if CONFIDENCE
    disparity |= here & 0xffff0000u;
#endif
    return disparity;
}

// Two pixels of a row.
uvec2 two(Cross c, bool flat_here, uvec2 luma, int j) {
    uint vertical = j == 0 ? c.above : c.below;
    uvec2 result = uvec2(on_plane(c.here, c.left, vertical), on_plane(c.here, c.right, vertical));
    if (!flat_here)
        result = uvec2(chosen(c, int(luma.x), 0, j), chosen(c, int(luma.y), 1, j));
    return result;
}

uvec4 disparities_at(int x, int y) {
    uvec4 words = coarse_disparity[(clamp(y, 0, coarse_size.y - 1) * coarse_stride + x) >> 2];
    // Behind the picture its last column repeats.
    int count = coarse_size.x - x;
    if (count < 4) words = uvec4(words.x, count < 2 ? uvec3(words.x) : count < 3 ? words.yyy : words.yzz);
    return words;
}
uvec4 bytes_of_word(uint word) { return uvec4(word, word >> 8, word >> 16, word >> 24) & 255u; }

bool is_flat(Cross c) {
    return (c.here & 0xffffu) != 0u && is_near(c.here, c.left) && is_near(c.here, c.right) &&
           is_near(c.here, c.above) && is_near(c.here, c.below);
}

void main() {
    int x = int(gl_GlobalInvocationID.x) * 4, y = int(gl_GlobalInvocationID.y);
    if (x >= coarse_size.x || y >= coarse_size.y) return;
    uvec4 here = disparities_at(x, y), above = disparities_at(x, y - 1), below = disparities_at(x, y + 1);
    uint before = x > 0 ? disparities_at(x - 4, y).w : here.x;
    uint after = x + 4 < coarse_size.x ? disparities_at(x + 4, y).x : here.w;
    // Each row of luma has a word of its repeated edge before and behind it.
    int word = y * coarse_row_words + (x >> 2) + 1;
    ivec4 luma_here = ivec4(bytes_of_word(coarse_luma[word]));
    ivec4 luma_above = ivec4(bytes_of_word(coarse_luma[y > 0 ? word - coarse_row_words : word]));
    ivec4 luma_below = ivec4(bytes_of_word(coarse_luma[y + 1 < coarse_size.y ? word + coarse_row_words : word]));
    int luma_before = int(coarse_luma[word - 1] >> 24), luma_after = int(coarse_luma[word + 1] & 255u);
#define CROSS(k, left, right, luma_left, luma_right)                                                      \
    Cross(here[k], left, right, above[k], below[k], luma_here[k], luma_left, luma_right, luma_above[k], luma_below[k])
    Cross a = CROSS(0, before, here.y, luma_before, luma_here.y);
    Cross b = CROSS(1, here.x, here.z, luma_here.x, luma_here.z);
    Cross c = CROSS(2, here.y, here.w, luma_here.y, luma_here.w);
    Cross d = CROSS(3, here.z, after, luma_here.z, luma_after);
    bool a_flat = is_flat(a), b_flat = is_flat(b), c_flat = is_flat(c), d_flat = is_flat(d);
    for (int j = 0; j < 2; ++j) {
        int fine_y = 2 * y + j, fine_x = 2 * x;
        if (fine_y >= fine_size.y) return;
        int fine_word = fine_y * fine_row_words + (fine_x >> 2) + 1, row = fine_y * fine_stride;
        int at = (row + fine_x) >> 2;
        uvec4 luma = bytes_of_word(fine_luma[fine_word]);
        leave(at, uvec4(two(a, a_flat, luma.xy, j), two(b, b_flat, luma.zw, j)));
        if (fine_x + 4 >= fine_stride) continue;
        luma = bytes_of_word(fine_luma[fine_word + 1]);
        leave(at + 1, uvec4(two(c, c_flat, luma.xy, j), two(d, d_flat, luma.zw, j)));
    }
}
