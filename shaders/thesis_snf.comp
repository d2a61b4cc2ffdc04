// One iteration of symmetric neighbourhood filtering: of each pair of opposite neighbours in a 3x3
// window the one nearer to the centre's colour is kept, and the four that are kept are averaged.
#ifndef GROUP_WIDTH
#define GROUP_WIDTH 64
#endif
layout(local_size_x = GROUP_WIDTH) in;
layout(std430, binding = 0) readonly buffer Source { uint source[]; };
layout(std430, binding = 1) writeonly buffer Filtered { uint filtered[]; };
uniform ivec2 size;
#include "thesis_picture.glsl"

ivec3 source_at(ivec2 at) {
    ivec2 inside = clamp(at, ivec2(0), size - 1);
    return colour_of(source[inside.y * size.x + inside.x]);
}

ivec3 nearer_of_pair(ivec2 at, ivec2 offset, ivec3 centre) {
    ivec3 a = source_at(at + offset);
    ivec3 b = source_at(at - offset);
    return colour_distance(a, centre) <= colour_distance(b, centre) ? a : b;
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= size.x) return;
    ivec3 centre = source_at(at);
    ivec3 sum = nearer_of_pair(at, ivec2(1, 0), centre) + nearer_of_pair(at, ivec2(0, 1), centre) +
                nearer_of_pair(at, ivec2(1, 1), centre) + nearer_of_pair(at, ivec2(1, -1), centre);
    uvec3 mean = uvec3((sum + 2) >> 2);
    filtered[at.y * size.x + at.x] = mean.x | (mean.y << 8) | (mean.z << 16) | 0xff000000u;
}
