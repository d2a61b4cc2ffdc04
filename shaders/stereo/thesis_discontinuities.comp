// For every pixel, towards which of its four neighbours a discontinuity lies: the greatest of the
// three channels' differences is above the threshold, or there is no neighbour.
// Bits: 1 left, 2 right, 4 above, 8 below.
#ifndef GROUP_WIDTH
#define GROUP_WIDTH 64
#endif
layout(local_size_x = GROUP_WIDTH) in;
layout(std430, binding = 0) readonly buffer Picture { uint picture[]; };
layout(std430, binding = 1) writeonly buffer Discontinuities { uint discontinuities[]; };
uniform ivec2 size;
uniform int threshold;
#include "thesis_picture.glsl"

bool is_cut(ivec3 centre, ivec2 neighbour) {
    if (any(lessThan(neighbour, ivec2(0))) || any(greaterThanEqual(neighbour, size))) return true;
    ivec3 gradient = abs(colour_of(picture[neighbour.y * size.x + neighbour.x]) - centre);
    return max(gradient.x, max(gradient.y, gradient.z)) > threshold;
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= size.x) return;
    int index = at.y * size.x + at.x;
    ivec3 centre = colour_of(picture[index]);
    uint sides = 0u;
    if (is_cut(centre, at + ivec2(-1, 0))) sides |= 1u;
    if (is_cut(centre, at + ivec2(1, 0))) sides |= 2u;
    if (is_cut(centre, at + ivec2(0, -1))) sides |= 4u;
    if (is_cut(centre, at + ivec2(0, 1))) sides |= 8u;
    discontinuities[index] = sides;
}
