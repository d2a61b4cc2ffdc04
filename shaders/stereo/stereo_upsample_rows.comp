// Twice the height. A row of results lies between two coarse rows, a quarter beside the nearer one. Where both have
// nearly the same disparity, the result lies on the line through them. Elsewhere a pixel takes the disparity of that one
// which looks more like it, so that depth edges move to where they are. One invocation makes four pixels of two rows.
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
void leave(int at, uvec4 words) { fine_disparity[at] = whole((words.xz & 0xffffu) | (words.yw << 16)); }
#endif
uniform ivec2 coarse_size;
uniform int fine_height;
uniform int stride;
uniform int row_words;

const int most_step = 32;               // 1/32 px
const int own_far = 1, beside_far = 3;  // quarters of a coarse row

ivec4 bytes_of_word(uint word) { return ivec4(uvec4(word, word >> 8, word >> 16, word >> 24) & 255u); }

void main() {
    int x = int(gl_GlobalInvocationID.x), y = int(gl_GlobalInvocationID.y);
    if (x * 4 >= coarse_size.x || y >= coarse_size.y) return;
    uvec4 own = coarse_disparity[(y * stride >> 2) + x];
    ivec4 d = ivec4(own & 0xffffu);
    // Each row of luma has a word of its repeated edge before it.
    ivec4 own_luma = bytes_of_word(coarse_luma[y * row_words + x + 1]);
    for (int j = 0; j < 2; ++j) {
        int fine_y = 2 * y + j, beside_y = clamp(y - 1 + 2 * j, 0, coarse_size.y - 1);
        if (fine_y >= fine_height) return;
        uvec4 beside = coarse_disparity[(beside_y * stride >> 2) + x];
        ivec4 beside_d = ivec4(beside & 0xffffu), luma = bytes_of_word(fine_luma[fine_y * row_words + x + 1]);
        ivec4 own_cost = abs(luma - own_luma) + own_far;
        ivec4 beside_cost = abs(luma - bytes_of_word(coarse_luma[beside_y * row_words + x + 1])) + beside_far;
        uvec4 on_line = (own & 0xffff0000u) | uvec4((3 * d + beside_d + 2) >> 2);
        bvec4 is_near = lessThanEqual(abs(beside_d - d), ivec4(most_step));
        uvec4 is_line = uvec4(is_near) * uvec4(notEqual(d, ivec4(0))) * uvec4(notEqual(beside_d, ivec4(0)));
        uvec4 chosen = mix(own, beside, lessThan(beside_cost, own_cost));
        leave((fine_y * stride >> 2) + x, mix(chosen, on_line, equal(is_line, uvec4(1u))));
    }
}
