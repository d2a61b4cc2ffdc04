// The word that stands for a pixel in matching: 27 census bits (the odd squares of a 9x7 chessboard without its
// corners and its topmost middle, set where the neighbour is not darker; raster order from bit 0) and above them 5 bits of horizontal Sobel
// gradient in steps of 4, clamped. Both are blind to the brightness of the sensor, and nearly so to its gain. An
// invocation walks down ROWS rows of four pixels, which are compared four at a time, a byte each.
#include "stereo_common.glsl"

#ifndef ROWS
#define ROWS 8
#endif

// 1: makes the words anew if votes say that the picture lies lower or higher than it should, as if it did not.
#ifndef SHIFTED
#define SHIFTED 0
#endif

layout(local_size_x = PICTURE_LANES) in;
layout(std430, binding = 0) readonly buffer Luma { uint luma[]; };
layout(std430, binding = 1) writeonly buffer Features { uvec4 features[]; };
uniform ivec2 size;
uniform int row_words;
uniform int stride;

#if SHIFTED
#include "row_shift.glsl"
#endif

const uint high = 0x80808080u, low_bytes = 0x00ff00ffu;

// Four lumas at columns first .. first + 3 of a row's twelve (the four pixels are 4 .. 7).
#define AT(row, first)                                                                              \
    ((first) == 4   ? row.y                                                                         \
     : (first) == 0 ? row.x                                                                         \
     : (first) == 8 ? row.z                                                                         \
     : (first) < 4  ? (row.x >> (8 * (first))) | (row.y << (32 - 8 * (first)))                      \
                    : (row.y >> (8 * ((first)-4))) | (row.z << (32 - 8 * ((first)-4))))
// Bytewise: into the high bit of each of bits' bytes, whether the neighbour is not darker than the centre.
#define BIT(bits, row, dx)                                                                \
    {                                                                                     \
        uint n = AT(row, 4 + (dx));                                                       \
        bits = (bits >> 1) | (((n & bright) | ((n | bright) & ((n | high) - low))) & high); \
    }

int shift = 0;
uvec3 row_at(int y, int column) {
    int base = clamp(y + shift, 0, size.y - 1) * row_words + column;
    return uvec3(luma[base], luma[base + 1], luma[base + 2]);
}

// Rows weighted 1, 2, 1, a 16-bit pair a word: x of the even columns, y of the odd ones.
#define SUMS(part)                                                                                       \
    uvec2((a.part & low_bytes) + 2u * (b.part & low_bytes) + (c.part & low_bytes),                        \
          ((a.part >> 8) & low_bytes) + 2u * ((b.part >> 8) & low_bytes) + ((c.part >> 8) & low_bytes))

// In each byte's upper five bits.
uint gradients(uvec3 a, uvec3 b, uvec3 c) {
    uvec2 before = SUMS(x), here = SUMS(y), after = SUMS(z);
    const uint bias = 0x08000800u;
    uint even = here.y + bias - ((here.y << 16) | (before.y >> 16));
    uint odd = ((here.x >> 16) | (after.x << 16)) + bias - here.x;
    ivec4 steps = ivec4(even & 0xffffu, odd & 0xffffu, even >> 16, odd >> 16) - 2048;
    uvec4 levels = uvec4(clamp((steps >> 2) + 16, ivec4(0), ivec4(31)));
    return (levels.x << 3) | (levels.y << 11) | (levels.z << 19) | (levels.w << 27);
}

void main() {
    int column = int(gl_GlobalInvocationID.x), first_row = int(gl_GlobalInvocationID.y) * ROWS;
    if (column * 4 >= stride) return;
#if SHIFTED
    shift = row_shift();
    if (shift == 0) return;
#endif
    if (column + 2 >= row_words) {
        for (int y = first_row; y < min(first_row + ROWS, size.y); ++y)
            features[y * (stride / 4) + column] = uvec4(0u);
        return;
    }
    uvec3 a = row_at(first_row - 4, column), b = row_at(first_row - 3, column), c = row_at(first_row - 2, column);
    uvec3 d = row_at(first_row - 1, column), e = row_at(first_row, column), f = row_at(first_row + 1, column);
    uvec3 g = row_at(first_row + 2, column);
    for (int y = first_row; y < min(first_row + ROWS, size.y); ++y) {
        a = b, b = c, c = d, d = e, e = f, f = g;
        g = row_at(y + 3, column);
        uint bright = ~d.y, low = d.y & ~high;
        uint p = 0u, q = 0u, r = 0u, s = 0u;
        BIT(p, a, -2) BIT(p, a, 2)
        BIT(p, b, -3) BIT(p, b, -1) BIT(p, b, 1) BIT(p, b, 3)
        BIT(p, c, -4) BIT(p, c, -2) BIT(q, c, 0) BIT(q, c, 2) BIT(q, c, 4)
        BIT(q, d, -3) BIT(q, d, -1) BIT(q, d, 1) BIT(q, d, 3)
        BIT(q, e, -4) BIT(r, e, -2) BIT(r, e, 0) BIT(r, e, 2) BIT(r, e, 4)
        BIT(r, f, -3) BIT(r, f, -1) BIT(r, f, 1) BIT(r, f, 3)
        BIT(s, g, -2) BIT(s, g, 0) BIT(s, g, 2)
        s = ((s >> 5) & 0x07070707u) | gradients(c, d, e);
        // Bytes of four pixels a word become a word a pixel.
        uvec2 even = (uvec2(p, r) & low_bytes) | ((uvec2(q, s) & low_bytes) << 8);
        uvec2 odd = ((uvec2(p, r) >> 8) & low_bytes) | (uvec2(q, s) & ~low_bytes);
        features[y * (stride / 4) + column] =
            uvec4((even.x & 0xffffu) | (even.y << 16), (odd.x & 0xffffu) | (odd.y << 16),
                  (even.x >> 16) | (even.y & 0xffff0000u), (odd.x >> 16) | (odd.y & 0xffff0000u));
    }
}
