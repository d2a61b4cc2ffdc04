// How much of a sum passes from one pixel to the next, in sixteenths: 16 exp(-|step of the guide| / sigma), from a
// table. Bits 0-3: from the left neighbour; bits 4-7: from the upper one. Four pixels an invocation.
#include "stereo_common.glsl"

layout(local_size_x = PICTURE_LANES) in;
layout(std430, binding = 0) readonly buffer Guide { uint guide[]; };
layout(std430, binding = 1) writeonly buffer Permeability { uvec4 permeability[]; };
layout(std430, binding = 2) readonly buffer Table { uint table[]; };
uniform ivec2 size;
uniform int row_words;
uniform int stride;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x * 4 >= stride || at.y >= size.y) return;
    uvec4 mu = uvec4(0u);
    if (at.x + 2 < row_words) {
        int here = at.y * row_words + at.x + 1;
        uint word = guide[here], left = guide[here - 1], up = guide[at.y > 0 ? here - row_words : here];
        ivec4 centre = ivec4(byte_of(word, 0), byte_of(word, 1), byte_of(word, 2), byte_of(word, 3));
        ivec4 before = ivec4(byte_of(left, 3), centre.xyz);
        ivec4 above = ivec4(byte_of(up, 0), byte_of(up, 1), byte_of(up, 2), byte_of(up, 3));
        ivec4 dx = abs(centre - before), dy = abs(centre - above);
        uvec4 from_left = uvec4(table[dx.x], table[dx.y], table[dx.z], table[dx.w]);
        uvec4 from_above = uvec4(table[dy.x], table[dy.y], table[dy.z], table[dy.w]);
        if (at.x == 0) from_left.x = 0u;
        if (at.y == 0) from_above = uvec4(0u);
        mu = from_left | (from_above << 4);
        // Nothing comes in from behind the picture.
        mu *= uvec4(lessThan(ivec4(at.x * 4) + ivec4(0, 1, 2, 3), ivec4(size.x)));
    }
    permeability[at.y * (stride / 4) + at.x] = mu;
}
