// Half the size: the rounded mean of 2x2 lumas and colours (along z), in the same padded form. With ROWS_ONLY half the
// rows: the mean of two, rounded up.
#include "stereo_common.glsl"

#ifndef ROWS_ONLY
#define ROWS_ONLY 0
#endif

layout(local_size_x = PICTURE_LANES) in;
layout(std430, binding = 0) readonly buffer Fine { uint fine[]; };
layout(std430, binding = 1) writeonly buffer Coarse { uint coarse[]; };
uniform ivec2 fine_size;
uniform int fine_row_words;
uniform ivec2 coarse_size;
uniform int coarse_row_words;

uint fine_word(int y, int word) {
    int row = min(y, fine_size.y - 1) + int(gl_GlobalInvocationID.z) * fine_size.y;
    return fine[row * fine_row_words + word];
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= coarse_row_words || at.y >= coarse_size.y) return;
    int row = at.y + int(gl_GlobalInvocationID.z) * coarse_size.y;
#if ROWS_ONLY
    uint upper = fine_word(2 * at.y, at.x), lower = fine_word(2 * at.y + 1, at.x);
    coarse[row * coarse_row_words + at.x] = (upper | lower) - (((upper ^ lower) >> 1) & 0x7f7f7f7fu);
#else
    // The four pixels of this word, or those of the nearest one that holds some of the picture.
    int x = clamp((at.x - 1) * 4, 0, (coarse_size.x - 1) & ~3), word = (x >> 1) + 1;
    uint first = means_of_2x2(fine_word(2 * at.y, word), fine_word(2 * at.y + 1, word));
    uint second = means_of_2x2(fine_word(2 * at.y, word + 1), fine_word(2 * at.y + 1, word + 1));
    uvec4 four = uvec4(first & 255u, first >> 16, second & 255u, second >> 16);
    // The first and the last pixel repeat beside the picture.
    int last = coarse_size.x - 1 - x;
    if (last < 3) four = uvec4(four.x, last < 1 ? four.xxx : last < 2 ? four.yyy : four.yzz);
    if (at.x == 0) four = four.xxxx;
    if (x < (at.x - 1) * 4) four = four.wwww;
    // As whole() does, but of words that may be ~0; no row is without words.
    coarse[row * coarse_row_words + at.x] =
        max(four.x | (four.y << 8) | (four.z << 16) | (four.w << 24), uint(coarse_row_words == 0));
#endif
}
