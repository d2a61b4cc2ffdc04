// The triangles of a depth map's quad grid, cut where neighbouring pixels lie on different surfaces. Each
// invocation writes the six indices of one quad; a triangle that is left out is written as a point.
#ifndef STEP
#define STEP 1  // px of the depth map that a quad spans
#endif
#ifndef STEEPEST
#define STEEPEST 3.0  // times the tolerance: a slope that is never spanned
#endif

layout(local_size_x = 32, local_size_y = 4) in;

uniform sampler2D depth_map;  // metres, 0 = unknown, negative = guessed
uniform float tolerance;      // of a bend of inverse depth, as a share of the inverse depth

layout(std430, binding = 0) writeonly buffer Triangles { uint indices[]; };

float inverse_depth(ivec2 at, ivec2 size) {
    float z = abs(texelFetch(depth_map, clamp(at, ivec2(0), size - 1), 0).r);
    return z > 0.0 ? 1.0 / z : 0.0;
}

// Whether two neighbours lie on one surface: their step is small, or it goes on with the slope on one side of it, as
// on a slanted plane, whose inverse depth is linear in the picture. `before` and `after` are the next ones outward.
bool joined(float before, float a, float b, float after) {
    if (a <= 0.0 || b <= 0.0) return false;
    float scale = tolerance * max(a, b);
    float jump = b - a;
    float bend = abs(jump);
    if (before > 0.0) bend = min(bend, abs(jump - (a - before)));
    if (after > 0.0) bend = min(bend, abs(jump - (after - b)));
    return bend <= scale && abs(jump) <= STEEPEST * scale;
}

void main() {
    ivec2 size = textureSize(depth_map, 0);
    ivec2 quad = ivec2(gl_GlobalInvocationID.xy);
    ivec2 quads = (size - 1) / STEP;
    if (quad.x >= quads.x || quad.y >= quads.y) return;
    ivec2 at = STEP * quad;
    float a = inverse_depth(at, size);
    float b = inverse_depth(at + STEP * ivec2(1, 0), size);
    float c = inverse_depth(at + STEP * ivec2(0, 1), size);
    float d = inverse_depth(at + STEP * ivec2(1, 1), size);
    bool ab = joined(inverse_depth(at + STEP * ivec2(-1, 0), size), a, b, inverse_depth(at + STEP * ivec2(2, 0), size));
    bool cd = joined(inverse_depth(at + STEP * ivec2(-1, 1), size), c, d, inverse_depth(at + STEP * ivec2(2, 1), size));
    bool ac = joined(inverse_depth(at + STEP * ivec2(0, -1), size), a, c, inverse_depth(at + STEP * ivec2(0, 2), size));
    bool bd = joined(inverse_depth(at + STEP * ivec2(1, -1), size), b, d, inverse_depth(at + STEP * ivec2(1, 2), size));

    uint first = uint(at.y * size.x + at.x);
    uint down = uint(STEP * size.x), across = uint(STEP);
    uvec4 corner = uvec4(first, first + across, first + down, first + down + across);
    uvec3 one = uvec3(first), two = uvec3(first);
    if (ab && ac && bd && cd) {
        // The diagonal along which the surface bends less.
        if (abs(a - d) < abs(b - c)) {
            one = corner.xyw;
            two = corner.xwz;
        } else {
            one = corner.xyz;
            two = corner.ywz;
        }
    } else if (ab && ac) {
        one = corner.xyz;
    } else if (bd && cd) {
        one = corner.ywz;
    } else if (ab && bd) {
        one = corner.xyw;
    } else if (ac && cd) {
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
