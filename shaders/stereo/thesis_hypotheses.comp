// The cost of every disparity hypothesis: the absolute difference of left (x, y) and right
// (x - d, y), summed over the channels, in 1/32 grey levels of their mean, at most 1023. A
// hypothesis beyond the right picture's edge is compared with its edge pixel; the padding of the
// last slice costs 1023. Eight disparities make one element: disparity 8 s + 2 k + h of slice s is
// half h (0 = low) of component k.
#ifndef GROUP_WIDTH
#define GROUP_WIDTH 64
#endif
layout(local_size_x = GROUP_WIDTH) in;
layout(std430, binding = 0) readonly buffer Left { uint left[]; };
layout(std430, binding = 1) readonly buffer Right { uint right[]; };
layout(std430, binding = 2) writeonly buffer Costs { uvec4 costs[]; };
uniform ivec2 size;
uniform int first_disparity; // of slice 0
uniform int disparities;     // of the whole search
#include "thesis_picture.glsl"

uint cost_of(ivec3 here, int x, int row, int d) {
    int distance = colour_distance(here, colour_of(right[row + max(x - d, 0)]));
    // 171 / 16 = 32 / 3; everything above 96 / 3 grey levels is over the top anyway.
    int cost = min((min(distance, 96) * 171) >> 4, 1023);
    return uint(d < disparities ? cost : 1023);
}

uint pair_of(ivec3 here, int x, int row, int d) {
    return cost_of(here, x, row, d) | (cost_of(here, x, row, d + 1) << 16);
}

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (at.x >= size.x) return;
    int row = at.y * size.x;
    int d = first_disparity + 8 * at.z;
    ivec3 here = colour_of(left[row + at.x]);
    costs[at.z * size.x * size.y + row + at.x] =
        uvec4(pair_of(here, at.x, row, d), pair_of(here, at.x, row, d + 2),
              pair_of(here, at.x, row, d + 4), pair_of(here, at.x, row, d + 6));
}
