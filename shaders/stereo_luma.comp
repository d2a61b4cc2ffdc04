// RGBA to luma (BT.601 weights / 256) and, one plane of luma behind it, to colour: half of red - blue, 128 where they
// are alike. Four pixels a word, each row with one word of repeated edge before it and one or more behind, so that
// neighbourhoods need no tests.
#include "stereo_common.glsl"

layout(local_size_x = PICTURE_LANES) in;
layout(std430, binding = 0) writeonly buffer Luma { uint luma[]; };
uniform highp sampler2D picture;
uniform ivec2 size;
uniform int row_words;

uvec3 rgb_at(int x, int y) {
    return uvec3(texelFetch(picture, ivec2(clamp(x, 0, size.x - 1), y), 0).rgb * 255.0 + 0.5);
}
uint luma_of(uvec3 c) { return (77u * c.r + 150u * c.g + 29u * c.b + 128u) >> 8; }
uint colour_of(uvec3 c) { return (c.r + 256u - c.b) >> 1; }

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= row_words || at.y >= size.y) return;
    int x = (at.x - 1) * 4;
    uvec3 a = rgb_at(x, at.y), b = rgb_at(x + 1, at.y), c = rgb_at(x + 2, at.y), d = rgb_at(x + 3, at.y);
    uint lumas = luma_of(a) | (luma_of(b) << 8) | (luma_of(c) << 16) | (luma_of(d) << 24);
    uint colours = colour_of(a) | (colour_of(b) << 8) | (colour_of(c) << 16) | (colour_of(d) << 24);
    // As whole() does, but of words that may be ~0; no row is without words.
    int word = at.y * row_words + at.x;
    luma[word] = max(lumas, uint(row_words == 0));
    luma[size.y * row_words + word] = max(colours, uint(row_words == 0));
}
