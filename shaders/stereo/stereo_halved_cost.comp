// Matching cost at half the size that sees every detail of the full one: the words compared are those of full-size
// pixels of each 2x2, and disparity d stands for 2d - 1, 2d and 2d + 1 there, of which the best counts. With BOTH they
// are (2x + 1, 2y) and (2x, 2y + 1), else the upper right one in even rows of 2x2 and the lower right one in odd rows. A byte a disparity in the order that perm_rows.comp takes (see perm_common.glsl). An invocation
// walks STEPS times four pixels of a row with one slab of 16 disparities: the right-hand words slide along.
#include "perm_common.glsl"

#ifndef BOTH
#define BOTH 1
#endif
#ifndef STEPS
#define STEPS 8
#endif

layout(local_size_x = LANES) in;
layout(std430, binding = 0) readonly buffer LeftFeatures { uvec4 left_features[]; };
layout(std430, binding = 1) readonly buffer RightFeatures { uvec4 right_features[]; };
layout(std430, binding = 2) writeonly buffer Costs { uvec4 costs[]; };
uniform ivec2 size;       // half-size
uniform ivec2 fine_size;
uniform int fine_stride;
uniform int plane;      // pixels of a slab of costs
uniform int first_row;  // of this run

// Full-size words of the upper and the lower row of 2x2, of even and of odd columns. Word i of a step at column x
// belongs to half-size column x - first_disparity - 16 + i.
uvec4 ue0, ue1, ue2, ue3, ue4, ue5, uo0, uo1, uo2, uo3, uo4, uo5;
uvec4 le0, le1, le2, le3, le4, le5, lo0, lo1, lo2, lo3, lo4, lo5;
#define AT(a, b, c, d, e, f, i) \
    ((i) < 4 ? a : (i) < 8 ? b : (i) < 12 ? c : (i) < 16 ? d : (i) < 20 ? e : f)[(i) & 3]
#define UE(i) AT(ue0, ue1, ue2, ue3, ue4, ue5, i)
#define UO(i) AT(uo0, uo1, uo2, uo3, uo4, uo5, i)
#define LE(i) AT(le0, le1, le2, le3, le4, le5, i)
#define LO(i) AT(lo0, lo1, lo2, lo3, lo4, lo5, i)

void take(int upper, int lower, int x) {
    int last = fine_stride - 4, a = clamp(2 * x, 0, last), b = clamp(2 * x + 4, 0, last);
    uvec4 p = right_features[(upper + a) >> 2], q = right_features[(upper + b) >> 2];
    ue5 = uvec4(p.xz, q.xz), uo5 = uvec4(p.yw, q.yw);
    p = right_features[(lower + a) >> 2], q = right_features[(lower + b) >> 2];
    le5 = uvec4(p.xz, q.xz), lo5 = uvec4(p.yw, q.yw);
    if (x < 0) {
        // The first column repeats before the picture.
        ue5 = uo5 = ue5.xxxx;
        le5 = lo5 = le5.xxxx;
    }
}
void slide() {
    ue0 = ue1, ue1 = ue2, ue2 = ue3, ue3 = ue4, ue4 = ue5;
    uo0 = uo1, uo1 = uo2, uo2 = uo3, uo3 = uo4, uo4 = uo5;
    le0 = le1, le1 = le2, le2 = le3, le3 = le4, le4 = le5;
    lo0 = lo1, lo1 = lo2, lo2 = lo3, lo3 = lo4, lo4 = lo5;
}

// There is no disparity -1.
uint before_first;

// i: the word that lies 2d away.
#define LEAST(l, two_d, more, less, j) \
    min(min(cost_of(l, two_d), cost_of(l, more)), (j) == 0 ? max(cost_of(l, less), before_first) : cost_of(l, less))
#define UPPER(u, i, j) LEAST(u, UO(i), UE(i), UE((i) + 1), j)
#if BOTH
#define COST(u, l, i, j) ((UPPER(u, i, j) + LEAST(l, LE(i), LO((i)-1), LO(i), j) + 1u) >> 1)
#else
#define COST(u, l, i, j) UPPER(u, i, j)
#endif
#define FOUR(u, l, k, j)                                                       \
    (COST(u, l, 16 + k - (j), j) | (COST(u, l, 12 + k - (j), (j) + 4) << 8) |  \
     (COST(u, l, 15 + k - (j), (j) + 1) << 16) | (COST(u, l, 11 + k - (j), (j) + 5) << 24))
#define PIXEL(u, l, k) \
    costs[at + k] = whole(uvec4(FOUR(u, l, k, 0), FOUR(u, l, k, 2), FOUR(u, l, k, 8), FOUR(u, l, k, 10)));

void main() {
    int x = int(gl_GlobalInvocationID.y) * 4 * STEPS, y = first_row + int(gl_GlobalInvocationID.x);
    int slab = int(gl_GlobalInvocationID.z);
    if (x >= size.x || y >= size.y) return;
    before_first = slab == 0 ? 31u : 0u;
#if BOTH
    int upper_row = 2 * y;
#else
    int upper_row = min(2 * y + (y & 1), fine_size.y - 1);
#endif
    int upper = upper_row * fine_stride, lower = min(2 * y + 1, fine_size.y - 1) * fine_stride, last = fine_stride - 4;
    int first = x - 16 * slab;
    take(upper, lower, first - 16);
    slide();
    take(upper, lower, first - 12);
    slide();
    take(upper, lower, first - 8);
    slide();
    take(upper, lower, first - 4);
    slide();
    take(upper, lower, first);
    int end = min(x + 4 * STEPS, size.x);
    for (; x < end; x += 4) {
        slide();
        take(upper, lower, x - 16 * slab + 4);
        int a = min(2 * x, last), b = min(2 * x + 4, last);
        uvec4 u = uvec4(left_features[(upper + a) >> 2].yw, left_features[(upper + b) >> 2].yw);
        uvec4 l = uvec4(left_features[(lower + a) >> 2].xz, left_features[(lower + b) >> 2].xz);
        int at = slab * plane + block_at(x, y, size.y);
        PIXEL(u.x, l.x, 0) PIXEL(u.y, l.y, 1) PIXEL(u.z, l.z, 2) PIXEL(u.w, l.w, 3)
    }
}
