// Half the size: the rounded mean of 2x2 lumas and colours (along z), in the same padded form.
#include "stereo_common.glsl"

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

uint mean_of(int x, int y) {
    int xf = 2 * clamp(x, 0, coarse_size.x - 1);
    // Pixel xf is byte xf % 4 of word xf / 4 + 1; its partner is in the same word.
    int word = (xf >> 2) + 1, first = xf & 3;
    uint a = fine_word(2 * y, word), b = fine_word(2 * y + 1, word);
    return (byte_of(a, first) + byte_of(a, first + 1) + byte_of(b, first) + byte_of(b, first + 1) + 2u) >> 2;
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= coarse_row_words || at.y >= coarse_size.y) return;
    int x = (at.x - 1) * 4;
    int row = at.y + int(gl_GlobalInvocationID.z) * coarse_size.y;
    coarse[row * coarse_row_words + at.x] = mean_of(x, at.y) | (mean_of(x + 1, at.y) << 8) |
                                            (mean_of(x + 2, at.y) << 16) | (mean_of(x + 3, at.y) << 24);
}
