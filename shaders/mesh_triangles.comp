// The triangles of a depth map's quad grid, cut where neighbouring pixels lie on different surfaces. Each
// invocation writes the six indices of one quad; a triangle that is left out is written as a point.
#ifndef STEP
#define STEP 1  // px of the depth map that a quad spans
#endif
#include "mesh_joints.glsl"

layout(local_size_x = 32, local_size_y = 4) in;

layout(std430, binding = 0) writeonly buffer Triangles { uint indices[]; };

void main() {
    ivec2 size = textureSize(depth_map, 0);
    ivec2 quad = ivec2(gl_GlobalInvocationID.xy);
    ivec2 quads = (size - 1) / STEP;
    if (quad.x >= quads.x || quad.y >= quads.y) return;
    ivec2 at = STEP * quad;
    Quad q = quad_at(at, STEP, size);

    uint first = uint(at.y * size.x + at.x);
    uint down = uint(STEP * size.x), across = uint(STEP);
    uvec4 corner = uvec4(first, first + across, first + down, first + down + across);
    uvec3 one = uvec3(first), two = uvec3(first);
    if (q.ab && q.ac && q.bd && q.cd) {
        // The diagonal along which the surface bends less.
        if (abs(q.a - q.d) < abs(q.b - q.c)) {
            one = corner.xyw;
            two = corner.xwz;
        } else {
            one = corner.xyz;
            two = corner.ywz;
        }
    } else if (q.ab && q.ac) {
        one = corner.xyz;
    } else if (q.bd && q.cd) {
        one = corner.ywz;
    } else if (q.ab && q.bd) {
        one = corner.xyw;
    } else if (q.ac && q.cd) {
        one = corner.xwz;
    }
    uint base = 6u * uint(quad.y * quads.x + quad.x);
    indices[base] = one.x;
    indices[base + 1u] = one.y;
    indices[base + 2u] = one.z;
    indices[base + 3u] = two.x;
    indices[base + 4u] = two.y;
    indices[base + 5u] = two.z;
}
