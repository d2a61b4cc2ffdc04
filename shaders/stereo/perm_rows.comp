// Cost and horizontal permeability aggregation of one slab of 16 disparities. An invocation walks a row there and
// back: A(x) = C(x) + mu(x) A(x - 1), likewise from the right, and leaves their sum, C(x) counted once, in 8 bits. Four
// pixels a step, so that their words come by one load. Going there it leaves only what comes to each step; coming back
// it makes the step's sums from that again. The matching cost never reaches memory: it is cheaper to find it twice.
// What lies behind the picture has no permeability and does no harm.
#include "perm_common.glsl"

// 1: costs are given, a byte each as sums are, slab after slab.
#ifndef GIVEN
#define GIVEN 0
#endif

#if LANE_MAPPING == LANES_DISPARITIES
#define SUMS uvec2  // half a slab an invocation
#define REACH 8
#define PARTS 1
#else
#define SUMS uvec4
#define REACH 16
#define PARTS 2
#endif

// 1: marks are kept at every eighth column, and the four pixels before a mark's second four are walked once more, which
// costs less than the memory traffic where costs are given.
#define SPARSE_MARKS (GIVEN && PARTS == 1)

layout(local_size_x = LANES) in;
#if GIVEN
// Without `readonly`, or else the compiler would read where a cost is needed and not where it is written.
layout(std430, binding = 0) buffer Costs { SUMS costs[]; };
uniform int plane;  // pixels of a slab of costs
#else
layout(std430, binding = 0) readonly buffer LeftFeatures { uvec4 left_features[]; };
layout(std430, binding = 1) readonly buffer RightFeatures { uvec4 right_features[]; };
#endif
layout(std430, binding = 2) readonly buffer Permeability { uint permeability[]; };  // a byte each
layout(std430, binding = 3) buffer Volume { SUMS volume[]; };
layout(std430, binding = 4) buffer Marks { uvec4 marks[]; };  // the sums from the left of a step
uniform ivec2 size;
uniform int stride;
uniform int first_disparity;

#if GIVEN
// What a pixel has to be compared by are its costs.
#define LEFT SUMS
#define COSTS_A(l, pixel) pairs_of(l.xy)
#define COSTS_B(l, pixel) pairs_of(l.zw)
#define LEFT_WORDS                                                                      \
    int costs_at = (first_disparity >> 4) * plane * (3 - PARTS) + SUMS_AT(x);           \
    LEFT l0 = costs[costs_at], l1 = costs[costs_at + 3 - PARTS];                        \
    LEFT l2 = costs[costs_at + 2 * (3 - PARTS)], l3 = costs[costs_at + 3 * (3 - PARTS)];
#else
#define LEFT uint
#define LEFT_WORDS                                      \
    uvec4 l = left_features[(row + x) >> 2];            \
    LEFT l0 = l.x, l1 = l.y, l2 = l.z, l3 = l.w;
// The right-hand words that four pixels see: column x - shift - REACH + i of pixel column x is R(i).
uvec4 r0, r1, r2, r3, r4;
#define R(i) ((i) < 4 ? r0 : (i) < 8 ? r1 : (i) < 12 ? r2 : (i) < 16 ? r3 : r4)[(i) & 3]
#define PAIR(l, i) (cost_of(l, R(i)) | (cost_of(l, R((i)-1)) << 16))
#define COSTS(l, i) uvec4(PAIR(l, i), PAIR(l, (i)-2), PAIR(l, (i)-4), PAIR(l, (i)-6))
#define COSTS_A(l, pixel) COSTS(l, REACH + pixel)
#define COSTS_B(l, pixel) COSTS(l, REACH - 8 + pixel)

// Before the picture its first column repeats: a word that matches nothing much would pull neighbours along.
uvec4 right_at(int row, int x) {
    uvec4 four = right_features[(row + max(x, 0)) >> 2];
    return x >= 0 ? four : four.xxxx;
}
#endif

uvec4 permeabilities(int at) {
    uint four = permeability[at >> 2];
    return uvec4(four, four >> 8, four >> 16, four >> 24) & 255u;
}

uvec4 a, b, back_a, back_b;

#if PARTS == 1
#define FORTH(pixel, l, m) a = COSTS_A(l, pixel) + permeate(a, m);
#define FORTH_AGAIN(pixel, l, m, own_a, own_b, sum_a, sum_b) \
    own_a = COSTS_A(l, pixel);                               \
    sum_a = a = own_a + permeate(a, m);
#define BACK(pixel, m, own_a, own_b, sum_a, sum_b)         \
    volume[at + 2 * pixel] = bytes_of((sum_a + back_a) >> 3); \
    back_a = permeate(back_a + own_a, m);
#else
#define FORTH(pixel, l, m)                  \
    a = COSTS_A(l, pixel) + permeate(a, m); \
    b = COSTS_B(l, pixel) + permeate(b, m);
#define FORTH_AGAIN(pixel, l, m, own_a, own_b, sum_a, sum_b) \
    own_a = COSTS_A(l, pixel);                               \
    own_b = COSTS_B(l, pixel);                               \
    sum_a = a = own_a + permeate(a, m);                      \
    sum_b = b = own_b + permeate(b, m);
#define BACK(pixel, m, own_a, own_b, sum_a, sum_b)                                                            \
    volume[at + pixel] = whole(uvec4(bytes_of((sum_a + back_a) >> 3), bytes_of((sum_b + back_b) >> 3))); \
    back_a = permeate(back_a + own_a, m);                                                                     \
    back_b = permeate(back_b + own_b, m);
#endif

// Always true. Where lanes are short of registers, a condition ends a block of code that the compiler puts into an order of
// its own: what is read before it is read together, and one wait is for all of it.
#if SPARSE_MARKS
#define THEN if (plane > 0)
#else
#define THEN
#endif

void main() {
#if LANE_MAPPING == LANES_DISPARITIES
    int y = int(gl_GlobalInvocationID.x >> 1), half_slab = int(gl_GlobalInvocationID.x & 1u);
#define SUMS_AT(x) (block_at(x, y, size.y) * 2 + half_slab)
#define MARK_AT(x) ((row + (x)) / 2 + half_slab)
    int shift = first_disparity + 8 * half_slab;
#else
    int y = int(gl_GlobalInvocationID.x);
#define SUMS_AT(x) block_at(x, y, size.y)
#define MARK_AT(x) ((row + (x)) / 2)
    int shift = first_disparity;
#endif
    if (y >= size.y) return;
    int row = y * stride, last = (size.x - 1) & ~3;
#if !GIVEN
    r0 = r1 = r2 = r3 = r4 = right_at(row, -4);
#endif
    a = b = uvec4(0u);

    for (int x = 0; x <= last; x += 4) {
#if GIVEN
#elif LANE_MAPPING == LANES_DISPARITIES
        r0 = r1, r1 = r2, r2 = right_at(row, x - shift);
#else
        r0 = r1, r1 = r2, r2 = r3, r3 = r4, r4 = right_at(row, x - shift);
#endif
        LEFT_WORDS
        uvec4 m = permeabilities(row + x);
        THEN {
#if SPARSE_MARKS
            if ((x & 4) == 0) marks[MARK_AT(x)] = a;
#else
            marks[MARK_AT(x)] = a;
#endif
#if PARTS == 2
            marks[MARK_AT(x) + 1] = b;
#endif
            FORTH(0, l0, m.x) FORTH(1, l1, m.y) FORTH(2, l2, m.z) FORTH(3, l3, m.w)
        }
    }

    // The words slide the other way.
    back_a = back_b = uvec4(0u);
    for (int x = last; x >= 0; x -= 4) {
#if SPARSE_MARKS
        a = marks[MARK_AT(x & ~4)];
        if ((x & 4) != 0) {
            x -= 4;
            LEFT_WORDS
            uvec4 m = permeabilities(row + x);
            THEN { FORTH(0, l0, m.x) FORTH(1, l1, m.y) FORTH(2, l2, m.z) FORTH(3, l3, m.w) }
            x += 4;
        }
#endif
        LEFT_WORDS
        uvec4 m = permeabilities(row + x);
        int at = SUMS_AT(x);
#if !SPARSE_MARKS
        a = marks[MARK_AT(x)];
#endif
#if PARTS == 2
        b = marks[MARK_AT(x) + 1];
#endif
        uvec4 own_a0, own_a1, own_a2, own_a3, own_b0, own_b1, own_b2, own_b3;
        uvec4 a0, a1, a2, a3, b0, b1, b2, b3;
        FORTH_AGAIN(0, l0, m.x, own_a0, own_b0, a0, b0) FORTH_AGAIN(1, l1, m.y, own_a1, own_b1, a1, b1)
        FORTH_AGAIN(2, l2, m.z, own_a2, own_b2, a2, b2) FORTH_AGAIN(3, l3, m.w, own_a3, own_b3, a3, b3)
        BACK(3, m.w, own_a3, own_b3, a3, b3) BACK(2, m.z, own_a2, own_b2, a2, b2)
        BACK(1, m.y, own_a1, own_b1, a1, b1) BACK(0, m.x, own_a0, own_b0, a0, b0)
#if !GIVEN
#if LANE_MAPPING != LANES_DISPARITIES
        r4 = r3, r3 = r2;
#endif
        r2 = r1, r1 = r0, r0 = right_at(row, x - 4 - shift - REACH);
#endif
    }
}
