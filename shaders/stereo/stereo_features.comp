// The word that stands for a pixel in matching: 17 census bits (the odd squares of a 7x5 chessboard without its upper
// right corner, set where the neighbour is not darker; raster order from bit 0), and above them 5 bits each of
// vertical Sobel gradient, of red - blue, and of horizontal Sobel gradient, in steps of 4, modulo 32: differences are
// truncated long before a way around the circle is the shorter one by mistake. All are blind to the brightness of
// the sensor, and nearly so to its gain. An invocation walks down ROWS rows of four pixels, which are compared four
// at a time, a byte each.
#include "stereo_common.glsl"

#ifndef ROWS
#define ROWS 8
#endif
#ifndef ROW_STEP
#define ROW_STEP 1  // 2: makes the words of one row of two, the upper and the lower one in turn; ROWS is a multiple of 4
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

// A 16-bit pair a word: x of a word's even columns, y of its odd ones.
uvec2 pairs_of_word(uint word) { return uvec2(word, word >> 8) & low_bytes; }

// Levels modulo 32 of four pixels' gradients, likewise in pairs. Biases are whole turns of the circle.
const uint levels = 0x001f001fu;

// Rows weighted 1, 2, 1.
uvec2 sums(uint a, uint b, uint c) { return pairs_of_word(a) + 2u * pairs_of_word(b) + pairs_of_word(c); }
uvec2 across(uvec3 a, uvec3 b, uvec3 c) {
    uvec2 before = sums(a.x, b.x, c.x), here = sums(a.y, b.y, c.y), after = sums(a.z, b.z, c.z);
    const uint bias = 0x08000800u;
    uint even = here.y + bias - ((here.y << 16) | (before.y >> 16));
    uint odd = ((here.x >> 16) | (after.x << 16)) + bias - here.x;
    return (uvec2(even, odd) >> 2) & levels;
}

uvec2 steps(uint a, uint c) { return pairs_of_word(c) + 0x01000100u - pairs_of_word(a); }
uvec2 down(uvec3 a, uvec3 c) {
    uvec2 before = steps(a.x, c.x), here = steps(a.y, c.y), after = steps(a.z, c.z);
    uint even = ((here.y << 16) | (before.y >> 16)) + 2u * here.x + here.y;
    uint odd = here.x + 2u * here.y + ((here.x >> 16) | (after.x << 16));
    return (uvec2(even, odd) >> 2) & levels;
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
    uvec3 a, b = row_at(first_row - 2, column), c = row_at(first_row - 1, column), d, e;
#if ROW_STEP == 1
    d = row_at(first_row, column), e = row_at(first_row + 1, column);
    for (int y = first_row; y < min(first_row + ROWS, size.y); ++y) {
        a = b, b = c, c = d, d = e;
#else
    // Rows 0, 3, 4, 7 and so on; where the last pair has no lower row, its upper one.
    for (int next = first_row; next < first_row + ROWS && (next & ~1) < size.y; next += (next & 1) == 0 ? 3 : 1) {
        bool is_upper = (next & 1) == 0;
        int y = min(next, size.y - 1);
        a = is_upper ? b : d, b = is_upper ? c : e;
        if (y < next) a = row_at(y - 2, column), b = row_at(y - 1, column);
        c = row_at(y, column), d = row_at(y + 1, column);
#endif
        e = row_at(y + 2, column);
        uint bright = ~c.y, low = c.y & ~high;
        uint p = 0u, q = 0u, r = 0u;
        BIT(p, a, -3) BIT(p, a, -1) BIT(p, a, 1)
        BIT(p, b, -2) BIT(p, b, 0) BIT(p, b, 2)
        BIT(p, c, -3) BIT(p, c, -1) BIT(q, c, 1) BIT(q, c, 3)
        BIT(q, d, -2) BIT(q, d, 0) BIT(q, d, 2)
        BIT(q, e, -3) BIT(q, e, -1) BIT(q, e, 1) BIT(r, e, 3)
        uint colours = luma[(size.y + clamp(y + shift, 0, size.y - 1)) * row_words + column + 1];
        // Bytes of four pixels a word become halves of words of even and odd ones, then a word a pixel.
        uvec2 lower = uvec2((p & low_bytes) | ((q & low_bytes) << 8), ((p >> 8) & low_bytes) | (q & ~low_bytes));
        uvec2 upper = (uvec2(r >> 7, r >> 15) & 0x00010001u) | (down(b, d) << 1) |
                      ((uvec2(colours >> 1, colours >> 9) & levels) << 6) | (across(b, c, d) << 11);
        uvec2 first = (lower & 0xffffu) | (upper << 16), second = (lower >> 16) | (upper & 0xffff0000u);
        features[y * (stride / 4) + column] = uvec4(first, second);
    }
}
