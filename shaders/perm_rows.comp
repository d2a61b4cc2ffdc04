// Cost and horizontal permeability aggregation of one slab of 16 disparities. An invocation walks a row there and
// back: A(x) = C(x) + mu(x) A(x - 1), likewise from the right, and leaves their sum, C(x) counted once, in 8 bits. The
// matching cost never reaches memory: it is cheaper to find it again on the way back.
#include "perm_common.glsl"

layout(local_size_x = LANES) in;
layout(std430, binding = 0) readonly buffer LeftFeatures { uint left_features[]; };
layout(std430, binding = 1) readonly buffer RightFeatures { uint right_features[]; };
layout(std430, binding = 2) readonly buffer Permeability { uint permeability[]; };
layout(std430, binding = 3) buffer Volume { uvec2 volume[]; };
uniform ivec2 size;
uniform int stride;
uniform int first_disparity;

#define PAIR(p, q) (cost_of(l, p) | (cost_of(l, q) << 16))
#define COSTS_A uvec4(PAIR(r0, r1), PAIR(r2, r3), PAIR(r4, r5), PAIR(r6, r7))
#define COSTS_B uvec4(PAIR(r8, r9), PAIR(r10, r11), PAIR(r12, r13), PAIR(r14, r15))

uint right_at(int row, int x) { return x >= 0 ? right_features[row + max(x, 0)] : outside_word; }

void main() {
#if LANE_MAPPING == LANES_DISPARITIES
    int y = int(gl_GlobalInvocationID.x >> 1), half_slab = int(gl_GlobalInvocationID.x & 1u);
    int shift = first_disparity + 8 * half_slab;
#else
    int y = int(gl_GlobalInvocationID.x);
    int shift = first_disparity;
    uint r8 = outside_word, r9 = outside_word, r10 = outside_word, r11 = outside_word;
    uint r12 = outside_word, r13 = outside_word, r14 = outside_word, r15 = outside_word;
    uvec4 b = uvec4(0u);
    const int half_slab = 0;
#endif
    if (y >= size.y) return;
    int row = y * stride;
    uint r0 = outside_word, r1 = outside_word, r2 = outside_word, r3 = outside_word;
    uint r4 = outside_word, r5 = outside_word, r6 = outside_word, r7 = outside_word;
    uvec4 a = uvec4(0u);

    for (int x = 0; x < size.x; ++x) {
        uint l = left_features[row + x];
        uint mu = permeability[row + x] & 15u;
        int at = (row + x) * 2 + half_slab;
        // The right-hand words slide through registers: disparity d sees at x what d - 1 saw at x - 1.
#if LANE_MAPPING == LANES_PIXELS
        r15 = r14, r14 = r13, r13 = r12, r12 = r11, r11 = r10, r10 = r9, r9 = r8, r8 = r7;
#endif
        r7 = r6, r6 = r5, r5 = r4, r4 = r3, r3 = r2, r2 = r1, r1 = r0;
        r0 = right_at(row, x - shift);
        a = COSTS_A + permeate(a, mu);
        volume[at] = bytes_of(a >> 1);
#if LANE_MAPPING == LANES_PIXELS
        b = COSTS_B + permeate(b, mu);
        volume[at + 1] = bytes_of(b >> 1);
#endif
    }

    // Now a and b are the sums from the right; the words slide the other way.
    a = uvec4(0u);
#if LANE_MAPPING == LANES_PIXELS
    b = uvec4(0u);
    int farthest = 15;
#else
    int farthest = 7;
#endif
    uint mu = 0u;
    for (int x = size.x - 1; x >= 0; --x) {
        uint l = left_features[row + x];
        int at = (row + x) * 2 + half_slab;
        a = permeate(a, mu);
        volume[at] = bytes_of(((pairs_of(volume[at]) << 1) + a) >> 3);
        a += COSTS_A;
        r0 = r1, r1 = r2, r2 = r3, r3 = r4, r4 = r5, r5 = r6, r6 = r7;
#if LANE_MAPPING == LANES_PIXELS
        b = permeate(b, mu);
        volume[at + 1] = bytes_of(((pairs_of(volume[at + 1]) << 1) + b) >> 3);
        b += COSTS_B;
        r7 = r8, r8 = r9, r9 = r10, r10 = r11, r11 = r12, r12 = r13, r13 = r14, r14 = r15;
        r15 = right_at(row, x - 1 - shift - farthest);
#else
        r7 = right_at(row, x - 1 - shift - farthest);
#endif
        mu = permeability[row + x] & 15u;
    }
}
