// Cost and horizontal permeability aggregation of one slab of 16 disparities. An invocation walks a row there and
// back: A(x) = C(x) + mu(x) A(x - 1), likewise from the right, and leaves their sum, C(x) counted once, in 8 bits. The
// matching cost never reaches memory: it is cheaper to find it again on the way back. Four pixels a step, so that
// their words come by one load; what lies behind the picture has no permeability and does no harm.
#include "perm_common.glsl"

#if LANE_MAPPING == LANES_DISPARITIES
#define SUMS uvec2  // half a slab an invocation
#define REACH 8
#else
#define SUMS uvec4
#define REACH 16
#endif

layout(local_size_x = LANES) in;
layout(std430, binding = 0) readonly buffer LeftFeatures { uvec4 left_features[]; };
layout(std430, binding = 1) readonly buffer RightFeatures { uvec4 right_features[]; };
layout(std430, binding = 2) readonly buffer Permeability { uvec4 permeability[]; };
layout(std430, binding = 3) buffer Volume { SUMS volume[]; };
uniform ivec2 size;
uniform int stride;
uniform int first_disparity;

// The right-hand words that four pixels see: column x - shift - REACH + i of pixel column x is R(i).
uvec4 r0, r1, r2, r3, r4;
#define R(i) ((i) < 4 ? r0 : (i) < 8 ? r1 : (i) < 12 ? r2 : (i) < 16 ? r3 : r4)[(i) & 3]
#define PAIR(l, i) (cost_of(l, R(i)) | (cost_of(l, R((i)-1)) << 16))
#define COSTS(l, i) uvec4(PAIR(l, i), PAIR(l, (i)-2), PAIR(l, (i)-4), PAIR(l, (i)-6))
#define COSTS_A(l, pixel) COSTS(l, REACH + pixel)
#define COSTS_B(l, pixel) COSTS(l, REACH - 8 + pixel)

uvec4 right_at(int row, int x) { return x >= 0 ? right_features[(row + max(x, 0)) >> 2] : uvec4(outside_word); }

uvec4 a, b;

#if LANE_MAPPING == LANES_DISPARITIES
#define FORTH(pixel, l, m)                   \
    a = COSTS_A(l, pixel) + permeate(a, m);  \
    volume[at + 2 * pixel] = bytes_of(a >> 1);
#define BACK(pixel, l, m)                                                                   \
    a = permeate(a, mu);                                                                    \
    volume[at + 2 * pixel] = bytes_of(((pairs_of(volume[at + 2 * pixel]) << 1) + a) >> 3);  \
    a += COSTS_A(l, pixel);                                                                 \
    mu = m;
#else
#define FORTH(pixel, l, m)                   \
    a = COSTS_A(l, pixel) + permeate(a, m);  \
    b = COSTS_B(l, pixel) + permeate(b, m);  \
    volume[at + pixel] = uvec4(bytes_of(a >> 1), bytes_of(b >> 1));
#define BACK(pixel, l, m)                                                      \
    {                                                                          \
        uvec4 before = volume[at + pixel];                                     \
        a = permeate(a, mu);                                                   \
        b = permeate(b, mu);                                                   \
        volume[at + pixel] = uvec4(bytes_of(((pairs_of(before.xy) << 1) + a) >> 3),  \
                                   bytes_of(((pairs_of(before.zw) << 1) + b) >> 3)); \
        a += COSTS_A(l, pixel);                                                \
        b += COSTS_B(l, pixel);                                                \
        mu = m;                                                                \
    }
#endif

void main() {
#if LANE_MAPPING == LANES_DISPARITIES
    int y = int(gl_GlobalInvocationID.x >> 1), half_slab = int(gl_GlobalInvocationID.x & 1u);
#define SUMS_AT(x) (block_at(x, y, size.y) * 2 + half_slab)
    int shift = first_disparity + 8 * half_slab;
#else
    int y = int(gl_GlobalInvocationID.x);
#define SUMS_AT(x) block_at(x, y, size.y)
    int shift = first_disparity;
#endif
    if (y >= size.y) return;
    int row = y * stride, last = (size.x - 1) & ~3;
    r0 = r1 = r2 = r3 = r4 = uvec4(outside_word);
    a = b = uvec4(0u);

    for (int x = 0; x <= last; x += 4) {
#if LANE_MAPPING == LANES_DISPARITIES
        r0 = r1, r1 = r2, r2 = right_at(row, x - shift);
#else
        r0 = r1, r1 = r2, r2 = r3, r3 = r4, r4 = right_at(row, x - shift);
#endif
        uvec4 l = left_features[(row + x) >> 2], m = permeability[(row + x) >> 2] & 15u;
        int at = SUMS_AT(x);
        FORTH(0, l.x, m.x) FORTH(1, l.y, m.y) FORTH(2, l.z, m.z) FORTH(3, l.w, m.w)
    }

    // Now a and b are the sums from the right; the words slide the other way.
    a = b = uvec4(0u);
    uint mu = 0u;
    for (int x = last; x >= 0; x -= 4) {
        uvec4 l = left_features[(row + x) >> 2], m = permeability[(row + x) >> 2] & 15u;
        int at = SUMS_AT(x);
        BACK(3, l.w, m.w) BACK(2, l.z, m.z) BACK(1, l.y, m.y) BACK(0, l.x, m.x)
#if LANE_MAPPING != LANES_DISPARITIES
        r4 = r3, r3 = r2;
#endif
        r2 = r1, r1 = r0, r0 = right_at(row, x - 4 - shift - REACH);
    }
}
