// RGBA to luma (BT.601 weights / 256) and, one plane of luma behind it, to colour: half of red - blue, 128 where they
// are alike. Four pixels a word, each row with one word of repeated edge before it and one or more behind, so that
// neighbourhoods need no tests. OF_STREAM 1: what stands still in a stream of pictures is averaged along time first,
// against the sensor's noise: a running mean, the mean of the first frames, later an eighth of the way to the new value.
#include "stereo_common.glsl"

#ifndef OF_STREAM
#define OF_STREAM 0
#endif
#ifndef MOST_NOISE
#define MOST_NOISE 10  // grey levels that luma or colour may lie off their mean
#endif

layout(local_size_x = PICTURE_LANES) in;
layout(std430, binding = 0) buffer Luma { uint luma[]; };
uniform highp sampler2D picture;
uniform ivec2 size;
uniform int row_words;

uvec3 rgb_at(int x, int y) {
    return uvec3(ivec3(roundEven(texelFetch(picture, ivec2(clamp(x, 0, size.x - 1), y), 0).rgb * 255.0)));
}
#if OF_STREAM
// 16 bits a pixel: how far the means of luma and colour in 1/64 lie above the levels that were written, plus 32, in six
// bits each, and the number of frames above them.
layout(std430, binding = 1) buffer State { uvec2 state[]; };
layout(std430, binding = 2) readonly buffer Exposure { int gain_4096; };  // since the last picture
uniform int has_state;

ivec4 levels_of(uint word) { return ivec4(uvec4(word, word >> 8, word >> 16, word >> 24) & 255u); }

// Puts means in the place of four pixels' values.
void average(int word, int colour_word, inout ivec4 luma_64, inout ivec4 colour_64) {
    const int white = 255 * 64, grey = 128 * 64;
    uvec2 packed_state = state[word];
    ivec4 before = ivec4(uvec4(packed_state & 0xffffu, packed_state >> 16).xzyw), frames = before >> 12;
    ivec4 luma_before = (levels_of(luma[word]) << 6) + (before & 63) - 32;
    ivec4 colour_before = (levels_of(luma[colour_word]) << 6) + ((before >> 6) & 63) - 32;
    luma_before = min((luma_before * gain_4096 + 2048) >> 12, ivec4(white));
    colour_before = ((colour_before - grey) * gain_4096 + 2048 >> 12) + grey;
    ivec4 to_luma = luma_64 - luma_before, to_colour = colour_64 - clamp(colour_before, ivec4(0), ivec4(white));
    ivec4 still = ivec4(lessThanEqual(max(abs(to_luma), abs(to_colour)), ivec4(MOST_NOISE * 64))) * has_state;
    ivec4 part = (frames + 2) >> 1, half_of_it = (ivec4(1) << part) >> 1;
    luma_64 += still * (((to_luma + half_of_it) >> part) - to_luma);
    colour_64 += still * (((to_colour + half_of_it) >> part) - to_colour);
    frames = min(still * frames + 1, ivec4(4));
    uvec4 after = uvec4(((luma_64 + 32) & 63) | (((colour_64 + 32) & 63) << 6) | (frames << 12));
    state[word] = after.xz | (after.yw << 16);
}
uint word_of(ivec4 values_64) {
    uvec4 v = uvec4(values_64 + 32) >> 6;
    return v.x | (v.y << 8) | (v.z << 16) | (v.w << 24);
}
#endif

uint luma_of(uvec3 c) { return (77u * c.r + 150u * c.g + 29u * c.b + 128u) >> 8; }
uint colour_of(uvec3 c) { return (c.r + 256u - c.b) >> 1; }

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= row_words || at.y >= size.y) return;
    int x = (at.x - 1) * 4;
    uvec3 a = rgb_at(x, at.y), b = rgb_at(x + 1, at.y), c = rgb_at(x + 2, at.y), d = rgb_at(x + 3, at.y);
#if OF_STREAM
    ivec4 luma_64 = ivec4(luma_of(a), luma_of(b), luma_of(c), luma_of(d)) << 6;
    ivec4 colour_64 = ivec4(colour_of(a), colour_of(b), colour_of(c), colour_of(d)) << 6;
    int word = at.y * row_words + at.x;
    average(word, word + size.y * row_words, luma_64, colour_64);
    uint lumas = word_of(luma_64), colours = word_of(colour_64);
#else
    int word = at.y * row_words + at.x;
    uint lumas = luma_of(a) | (luma_of(b) << 8) | (luma_of(c) << 16) | (luma_of(d) << 24);
    uint colours = colour_of(a) | (colour_of(b) << 8) | (colour_of(c) << 16) | (colour_of(d) << 24);
#endif
    // As whole() does, but of words that may be ~0; no row is without words.
    luma[word] = max(lumas, uint(row_words == 0));
    luma[size.y * row_words + word] = max(colours, uint(row_words == 0));
}
