// How much of a sum passes from one pixel to the next, in sixteenths: 16 exp(-step of the guide / sigma), from a table,
// where a step is that of luma and half of that of colour (half of red - blue); a byte each, four a word, as lines are
// walked: along rows of four pixels from the left, down columns of four rows from above. Four by four pixels an
// invocation.
#include "stereo_common.glsl"

layout(local_size_x = PICTURE_LANES) in;
layout(std430, binding = 0) readonly buffer Guide { uint guide[]; };
layout(std430, binding = 1) writeonly buffer Along { uint along[]; };
layout(std430, binding = 2) writeonly buffer Down { uvec4 down[]; };
layout(std430, binding = 3) readonly buffer Table { uint table[]; };
uniform ivec2 size;
uniform int row_words;
uniform int stride;

ivec4 bytes_of_word(uint word) { return ivec4(uvec4(word, word >> 8, word >> 16, word >> 24) & 255u); }
// Luma and colour of four pixels.
struct Four {
    ivec4 luma, colour;
};
Four four_at(int word) {
    return Four(bytes_of_word(guide[word]), bytes_of_word(guide[size.y * row_words + word]));
}
uvec4 passes(Four a, Four b) {
    ivec4 step = min(abs(a.luma - b.luma) + (abs(a.colour - b.colour) >> 1), ivec4(255));
    return uvec4(table[step.x], table[step.y], table[step.z], table[step.w]);
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    int first = at.y * 4;
    if (at.x * 4 >= stride || first >= size.y) return;
    // Nothing comes in from beside the picture or from behind it.
    uvec4 inside = uvec4(lessThan(ivec4(at.x * 4) + ivec4(0, 1, 2, 3), ivec4(size.x)));
    uvec4 inside_row = at.x > 0 ? inside : inside * uvec4(0u, 1u, 1u, 1u);
    Four above = four_at(max(first - 1, 0) * row_words + at.x + 1);
    uvec4 from_above = uvec4(0u);
    for (int y = first; y < min(first + 4, size.y); ++y) {
        int word = y * row_words + at.x + 1;
        Four here = four_at(word);
        int luma_before = int(guide[word - 1] >> 24), colour_before = int(guide[size.y * row_words + word - 1] >> 24);
        Four before = Four(ivec4(luma_before, here.luma.xyz), ivec4(colour_before, here.colour.xyz));
        uvec4 from_left = passes(here, before) * inside_row;
        along[y * (stride / 4) + at.x] =
            whole(from_left.x | (from_left.y << 8) | (from_left.z << 16) | (from_left.w << 24));
        if (y > 0) from_above |= (passes(here, above) * inside) << (8 * (y - first));
        above = here;
    }
    down[at.y * (stride / 4) + at.x] = whole(from_above);
}
