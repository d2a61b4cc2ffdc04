// Builds rims. The quad grid of a depth map ends at the middles of a surface's last pixels, half a pixel short of its
// edge, and lacks objects that are one pixel wide. So each corner of a cut quad that lies on its nearest surface gets its
// pixel's quarter of the quad. Vertices are 9 * pixel + 3 * (1 + y) + (1 + x), with x and y the side of the pixel's middle.
#include "mesh_joints.glsl"
#include "tolerances.glsl"

layout(local_size_x = 32, local_size_y = 4) in;

uniform int capacity;  // indices

layout(std430, binding = 0) writeonly buffer Rims { uint indices[]; };
layout(std430, binding = 1) buffer Command { uint count; };  // the first word of an indirect draw

void main() {
    ivec2 size = textureSize(depth_map, 0);
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= size.x - 1 || at.y >= size.y - 1) return;
    Quad q = quad_at(at, 1, size);
    if (q.ab && q.cd && q.ac && q.bd) return;
    vec4 inverse = vec4(q.a, q.b, q.c, q.d);
    float least = (1.0 - view_edge_share) * max(max(q.a, q.b), max(q.c, q.d));
    uint corners = 0u;
    for (int i = 0; i < 4; ++i) corners += inverse[i] > least ? 1u : 0u;
    if (corners == 0u) return;
    uint needed = 6u * corners, first = atomicAdd(count, needed), end = uint(capacity);
    if (first + needed > end) atomicMin(count, end);
    for (int i = 0; i < 4; ++i) {
        if (inverse[i] <= least || first + 6u > end) continue;
        ivec2 corner = ivec2(i & 1, i >> 1), inward = 1 - 2 * corner, pixel = at + corner;
        uint middle = 9u * uint(pixel.y * size.x + pixel.x) + 4u;
        uint beside = uint(int(middle) + inward.x), below = uint(int(middle) + 3 * inward.y);
        uint far = uint(int(middle) + inward.x + 3 * inward.y);
        // Mirrored quarters must have the same orientation.
        bool is_mirrored = inward.x * inward.y < 0;
        indices[first] = middle;
        indices[first + 1u] = is_mirrored ? far : beside;
        indices[first + 2u] = is_mirrored ? beside : far;
        indices[first + 3u] = middle;
        indices[first + 4u] = is_mirrored ? below : far;
        indices[first + 5u] = is_mirrored ? far : below;
        first += 6u;
    }
}
