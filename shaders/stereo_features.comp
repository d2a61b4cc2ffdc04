// The word that stands for a pixel in matching: 27 census bits (the odd squares of a 9x7 chessboard without its
// corners, set where the neighbour is not darker) and above them 5 bits of horizontal Sobel gradient in steps of 4,
// clamped. Both are blind to the brightness of the sensor, and nearly so to its gain. Four pixels an invocation.
#include "stereo_common.glsl"

layout(local_size_x = LANES) in;
layout(std430, binding = 0) readonly buffer Luma { uint luma[]; };
layout(std430, binding = 1) writeonly buffer Features { uvec4 features[]; };
uniform ivec2 size;
uniform int row_words;
uniform int stride;

uvec4 word;

// Bit for the neighbour at column i = 0..11 of the row's twelve lumas (the four pixels are 4..7) for each pixel.
#define BITS(row, dx)                                                                        \
    word = (word << 1) | uvec4(greaterThanEqual(uvec4(LUMA(row, 4 + dx), LUMA(row, 5 + dx),   \
                                                      LUMA(row, 6 + dx), LUMA(row, 7 + dx)), centre));
#define LUMA(row, i) ((i) < 4 ? byte_of(row.x, (i)) : (i) < 8 ? byte_of(row.y, (i)-4) : byte_of(row.z, (i)-8))

uvec3 row_at(int y, int at) {
    int base = clamp(y, 0, size.y - 1) * row_words + at;
    return uvec3(luma[base], luma[base + 1], luma[base + 2]);
}

uvec4 sobel(uvec3 above, uvec3 here, uvec3 below) {
#define STEP(i)                                                                          \
    (int(LUMA(above, i + 1)) - int(LUMA(above, i - 1)) + 2 * (int(LUMA(here, i + 1)) - int(LUMA(here, i - 1))) + \
     int(LUMA(below, i + 1)) - int(LUMA(below, i - 1)))
    ivec4 g = ivec4(STEP(4), STEP(5), STEP(6), STEP(7));
    return uvec4(clamp((g >> 2) + 16, ivec4(0), ivec4(31)));
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x * 4 >= stride || at.y >= size.y) return;
    if (at.x + 2 >= row_words) {
        features[at.y * (stride / 4) + at.x] = uvec4(0u);
        return;
    }
    uvec3 a = row_at(at.y - 3, at.x), b = row_at(at.y - 2, at.x), c = row_at(at.y - 1, at.x);
    uvec3 d = row_at(at.y, at.x), e = row_at(at.y + 1, at.x), f = row_at(at.y + 2, at.x);
    uvec3 g = row_at(at.y + 3, at.x);
    uvec4 centre = uvec4(LUMA(d, 4), LUMA(d, 5), LUMA(d, 6), LUMA(d, 7));
    word = uvec4(0u);
    BITS(a, -2) BITS(a, 0) BITS(a, 2)
    BITS(b, -3) BITS(b, -1) BITS(b, 1) BITS(b, 3)
    BITS(c, -4) BITS(c, -2) BITS(c, 0) BITS(c, 2) BITS(c, 4)
    BITS(d, -3) BITS(d, -1) BITS(d, 1) BITS(d, 3)
    BITS(e, -4) BITS(e, -2) BITS(e, 0) BITS(e, 2) BITS(e, 4)
    BITS(f, -3) BITS(f, -1) BITS(f, 1) BITS(f, 3)
    BITS(g, -2) BITS(g, 0) BITS(g, 2)
    features[at.y * (stride / 4) + at.x] = word | (sobel(c, d, e) << 27);
}
