// RGBA to luma (BT.601 weights / 256), four pixels a word, each row with one word of repeated edge before it
// and one or more behind, so that neighbourhoods need no tests.
#include "stereo_common.glsl"

layout(local_size_x = PICTURE_LANES) in;
layout(std430, binding = 0) writeonly buffer Luma { uint luma[]; };
uniform highp sampler2D picture;
uniform ivec2 size;
uniform int row_words;

uint luma_at(int x, int y) {
    uvec4 c = uvec4(texelFetch(picture, ivec2(clamp(x, 0, size.x - 1), y), 0) * 255.0 + 0.5);
    return (77u * c.r + 150u * c.g + 29u * c.b + 128u) >> 8;
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= row_words || at.y >= size.y) return;
    int x = (at.x - 1) * 4;
    uint four = luma_at(x, at.y) | (luma_at(x + 1, at.y) << 8) | (luma_at(x + 2, at.y) << 16) |
                (luma_at(x + 3, at.y) << 24);
    // As whole() does, but of words that may be ~0; no row is without words.
    luma[at.y * row_words + at.x] = max(four, uint(row_words == 0));
}
