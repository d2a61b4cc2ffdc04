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
uvec2 results(Cross c, bool flat_here, uvec2 luma, int j) {
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
    uint luma_here = coarse_luma[word], luma_before = coarse_luma[word - 1] >> 24, luma_after = coarse_luma[word + 1];
    uint luma_above = coarse_luma[y > 0 ? word - coarse_row_words : word];
    uint luma_below = coarse_luma[y + 1 < coarse_size.y ? word + coarse_row_words : word];
    // Two coarse pixels after the other: fewer registers hold what they need.
    int two = 2 + min(coarse_stride, 0);  // 2, and loops that the compiler does not unroll
    for (int half_of_word = 0; half_of_word < two; ++half_of_word) {
        int fine_x = 2 * x + 4 * half_of_word;
        if (fine_x >= fine_stride) return;
        Cross a = Cross(here.x, before, here.y, above.x, below.x, int(luma_here & 255u), int(luma_before & 255u),
                        int(byte_of(luma_here, 1)), int(luma_above & 255u), int(luma_below & 255u));
        Cross b = Cross(here.y, here.x, here.z, above.y, below.y, int(byte_of(luma_here, 1)), int(luma_here & 255u),
                        int(byte_of(luma_here, 2)), int(byte_of(luma_above, 1)), int(byte_of(luma_below, 1)));
        bool a_flat = is_flat(a), b_flat = is_flat(b);
        for (int j = 0; j < two; ++j) {
            int fine_y = 2 * y + j;
            if (fine_y >= fine_size.y) break;
            uvec4 luma = bytes_of_word(fine_luma[fine_y * fine_row_words + (fine_x >> 2) + 1]);
            leave((fine_y * fine_stride + fine_x) >> 2,
                  uvec4(results(a, a_flat, luma.xy, j), results(b, b_flat, luma.zw, j)));
        }
        before = here.y, here.xyz = uvec3(here.zw, after), above.xy = above.zw, below.xy = below.zw;
        luma_before = byte_of(luma_here, 1);
        luma_here = (luma_here >> 16) | (luma_after << 16), luma_above >>= 16, luma_below >>= 16;
    }
}
