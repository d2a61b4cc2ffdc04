// How badly the right picture matches when it is taken to lie 2 .. -2 rows lower: for one pixel in 8x16, the least
// matching cost over the search range, summed into votes[shift + 2] (which start at ~0, one below nothing).
#include "perm_common.glsl"

layout(local_size_x = LANES) in;
layout(std430, binding = 0) readonly buffer LeftFeatures { uint left_features[]; };
layout(std430, binding = 1) readonly buffer RightFeatures { uvec4 right_features[]; };
layout(std430, binding = 2) buffer Votes { uint votes[5]; };
uniform ivec2 size;
uniform int stride;
uniform int disparities;

void main() {
    int x = int(gl_GlobalInvocationID.x) * 8 + 4, y = int(gl_GlobalInvocationID.y) * 16 + 8;
    if (x >= size.x || y >= size.y) return;
    uint left = left_features[y * stride + x];
    int r0 = max(y - 2, 0) * stride + x, r1 = max(y - 1, 0) * stride + x, r2 = y * stride + x;
    int r3 = min(y + 1, size.y - 1) * stride + x, r4 = min(y + 2, size.y - 1) * stride + x;
    // Four disparities a step, whose words come by one load; x is a multiple of four.
#define FIRST(r) cost_of(left, right_features[(r) >> 2].x)
    uint l0 = FIRST(r0), l1 = FIRST(r1), l2 = FIRST(r2), l3 = FIRST(r3), l4 = FIRST(r4);
    int most = min(disparities - 1, x);
    for (int d = 1; d <= most; d += 4) {
        // What lies beyond the range costs most.
        uvec3 beyond = uvec3(lessThan(ivec3(most), ivec3(d + 1, d + 2, d + 3))) * 32u;
#define LEAST(l, r)                                                                                          \
    {                                                                                                        \
        uvec4 words = right_features[((r) - d - 3) >> 2];                                                    \
        uvec4 costs = uvec4(cost_of(left, words.w), cost_of(left, words.z), cost_of(left, words.y), cost_of(left, words.x)); \
        costs.yzw = max(costs.yzw, beyond);                                                                  \
        l = min(min(l, min(costs.x, costs.y)), min(costs.z, costs.w));                                       \
    }
        LEAST(l0, r0)
        LEAST(l1, r1)
        LEAST(l2, r2)
        LEAST(l3, r3)
        LEAST(l4, r4)
    }
    atomicAdd(votes[0], l0);
    atomicAdd(votes[1], l1);
    atomicAdd(votes[2], l2);
    atomicAdd(votes[3], l3);
    atomicAdd(votes[4], l4);
}
