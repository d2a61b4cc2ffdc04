// Semi-global matching (Hirschmueller 2008) along lines, there and back:
// L(p, d) = C(p, d) + min(q(d), q(d - 1) + P1, q(d + 1) + P1, P2), q = L(p - 1) - its least. An invocation walks a
// line with all its disparities in registers, four a word: values stay below 128, so that the upper bit of a byte can
// tell the lesser of two. ALONG 0 walks rows, 1 columns; ADD adds to sums that are there already; DECIDE takes the
// winner on the way back instead of leaving sums.
#include "stereo_common.glsl"
#include "winner_takes_all.glsl"

#ifndef ALONG
#define ALONG 0
#endif
#ifndef ADD
#define ADD 0
#endif
#ifndef DECIDE
#define DECIDE 1
#endif
#ifndef SLABS
#define SLABS 1  // of 16 disparities, 1..16
#endif
#ifndef VALID
#define VALID 16  // disparities of the last slab that count
#endif
#ifndef P1
#define P1 4
#endif
#ifndef P2
#define P2 20
#endif

layout(local_size_x = LANES) in;
layout(std430, binding = 0) readonly buffer Costs { uvec4 costs[]; };  // up to 127 - P2, a byte each, slab after slab
layout(std430, binding = 1) buffer Sums { uvec4 sums[]; };             // up to 255, pixel after pixel
layout(std430, binding = 2) writeonly buffer Winners { uvec2 winners[]; };
uniform ivec2 size;
uniform int plane;  // pixels of a slab of costs
// The sums' buffer has so many rows, the first of which is row first_row of the picture.
uniform int first_row;
uniform int sum_rows;
uniform int first_line;  // of this run: a row counted from first_row, or a column

const uint ones = 0x01010101u, high = 0x80808080u, low_bytes = 0x00ff00ffu;
const uint edge = uint(P2) * ones;

uvec4 least4(uvec4 a, uvec4 b) {
    uvec4 ahead = (a | high) - b, over = ahead & high;
    return a - (ahead & (over - (over >> 7)));
}
uint least_byte(uvec4 four) {
    uvec4 bytes = min(min(four & 255u, (four >> 8) & 255u), min((four >> 16) & 255u, four >> 24));
    return min(min(bytes.x, bytes.y), min(bytes.z, bytes.w));
}

uvec4 least;
uint carry;
int from, at;

// All bits of the bytes that stand for no disparity, in the last slab.
#define NONE(w) (VALID <= 4 * w ? ~0u : VALID >= 4 * w + 4 ? 0u : ~0u << (8 * ((VALID - 4 * w) & 3)))
const uvec4 none = uvec4(NONE(0), NONE(1), NONE(2), NONE(3)) & 0x7f7f7f7fu;

// One slab of a step; q becomes L.
#define STEP(k, q, next)                                                       \
    {                                                                          \
        uvec4 below = (q << 8) | (uvec4(carry, q.xyz) >> 24);                  \
        uvec4 above = (q >> 8) | (uvec4(q.yzw, next) << 24);                   \
        carry = q.w;                                                           \
        q = costs[from + k * plane] + least4(q, least4(below, above) + uint(P1) * ones); \
        if (VALID < 16 && k == SLABS - 1) q |= none;                           \
        least = least4(least, q);                                              \
    }
#define LEAVE(k, q) sums[at + k] = q;
#define LEAVE_MORE(k, q) sums[at + k] += q;
#define TAKE(k, q)                                                                                                 \
    {                                                                                                              \
        uvec4 s = sums[at + k], even = (s & low_bytes) + (q & low_bytes), odd = ((s >> 8) & low_bytes) + ((q >> 8) & low_bytes); \
        uvec4 lower = (even & 0xffffu) | (odd << 16), upper = (even >> 16) | (odd & 0xffff0000u);                  \
        consider_slab(16 * k, uvec4(lower.x, upper.x, lower.y, upper.y), uvec4(lower.z, upper.z, lower.w, upper.w), \
                      k == SLABS - 1 ? VALID : 16);                                                                \
    }
#define REST(k, q) q = least4(q - most, uvec4(edge));

uvec4 q0, q1, q2, q3, q4, q5, q6, q7, q8, q9, q10, q11, q12, q13, q14, q15;
#define FIRST(n, q) (n < SLABS ? q.x : edge)
#define IF(k, what) if (k < SLABS) what
#define STEPS                                                                                         \
    IF(0, STEP(0, q0, FIRST(1, q1))) IF(1, STEP(1, q1, FIRST(2, q2))) IF(2, STEP(2, q2, FIRST(3, q3)))    \
    IF(3, STEP(3, q3, FIRST(4, q4))) IF(4, STEP(4, q4, FIRST(5, q5))) IF(5, STEP(5, q5, FIRST(6, q6)))    \
    IF(6, STEP(6, q6, FIRST(7, q7))) IF(7, STEP(7, q7, FIRST(8, q8))) IF(8, STEP(8, q8, FIRST(9, q9)))    \
    IF(9, STEP(9, q9, FIRST(10, q10))) IF(10, STEP(10, q10, FIRST(11, q11)))                          \
    IF(11, STEP(11, q11, FIRST(12, q12))) IF(12, STEP(12, q12, FIRST(13, q13)))                       \
    IF(13, STEP(13, q13, FIRST(14, q14))) IF(14, STEP(14, q14, FIRST(15, q15))) IF(15, STEP(15, q15, edge))
#define EACH(what)                                                                                            \
    IF(0, what(0, q0)) IF(1, what(1, q1)) IF(2, what(2, q2)) IF(3, what(3, q3)) IF(4, what(4, q4))            \
    IF(5, what(5, q5)) IF(6, what(6, q6)) IF(7, what(7, q7)) IF(8, what(8, q8)) IF(9, what(9, q9))            \
    IF(10, what(10, q10)) IF(11, what(11, q11)) IF(12, what(12, q12)) IF(13, what(13, q13))                   \
    IF(14, what(14, q14)) IF(15, what(15, q15))

void start() {
    q0 = q1 = q2 = q3 = q4 = q5 = q6 = q7 = q8 = q9 = q10 = q11 = q12 = q13 = q14 = q15 = uvec4(0u);
}

void main() {
#if ALONG == 0
    int y = int(gl_GlobalInvocationID.x) + first_line + first_row, count = size.x;
    if (y >= min(first_row + sum_rows, size.y)) return;
#define GO_TO(i)                              \
    int pixel = block_at(i, y, size.y);       \
    from = pixel;                             \
    at = block_at(i, y - first_row, sum_rows) * SLABS;
#else
    int x = int(gl_GlobalInvocationID.x) + first_line, count = size.y;
    if (x >= size.x) return;
#define GO_TO(i)                              \
    int pixel = block_at(x, i, size.y);       \
    from = pixel;                             \
    at = pixel * SLABS;
#endif

    start();
    for (int i = 0; i < count; ++i) {
        GO_TO(i)
        carry = edge;
        least = uvec4(0x7f7f7f7fu);
        STEPS
#if ADD
        EACH(LEAVE_MORE)
#else
        EACH(LEAVE)
#endif
        uint most = least_byte(least) * ones;
        EACH(REST)
    }

    start();
    for (int i = count - 1; i >= 0; --i) {
        GO_TO(i)
        carry = edge;
        least = uvec4(0x7f7f7f7fu);
        STEPS
#if DECIDE
        no_winner_yet();
        EACH(TAKE)
        winners[pixel] = winner();
#else
        EACH(LEAVE_MORE)
#endif
        uint most = least_byte(least) * ones;
        EACH(REST)
    }
}
