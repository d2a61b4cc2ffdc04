// How badly the right picture matches when it is taken to lie 2 .. -2 rows lower: for one pixel in 8x16, the least
// matching cost over the search range, summed into votes[shift + 2] (which start at ~0, one below nothing).
#include "perm_common.glsl"

layout(local_size_x = LANES) in;
layout(std430, binding = 0) readonly buffer LeftFeatures { uint left_features[]; };
layout(std430, binding = 1) readonly buffer RightFeatures { uint right_features[]; };
layout(std430, binding = 2) buffer Votes { uint votes[]; };
uniform ivec2 size;
uniform int stride;
uniform int disparities;

void main() {
    int x = int(gl_GlobalInvocationID.x) * 8 + 4, y = int(gl_GlobalInvocationID.y) * 16 + 8;
    if (x >= size.x || y >= size.y) return;
    uint left = left_features[y * stride + x];
    int r0 = max(y - 2, 0) * stride + x, r1 = max(y - 1, 0) * stride + x, r2 = y * stride + x;
    int r3 = min(y + 1, size.y - 1) * stride + x, r4 = min(y + 2, size.y - 1) * stride + x;
    int l0 = 32, l1 = 32, l2 = 32, l3 = 32, l4 = 32;
#define DISTANCE(r) int(cost_of(left, right_features[r - d]))
    int most = min(disparities - 1, x);
    for (int d = 0; d <= most; ++d) {
        l0 = min(l0, DISTANCE(r0));
        l1 = min(l1, DISTANCE(r1));
        l2 = min(l2, DISTANCE(r2));
        l3 = min(l3, DISTANCE(r3));
        l4 = min(l4, DISTANCE(r4));
    }
    atomicAdd(votes[0], uint(l0));
    atomicAdd(votes[1], uint(l1));
    atomicAdd(votes[2], uint(l2));
    atomicAdd(votes[3], uint(l3));
    atomicAdd(votes[4], uint(l4));
}
