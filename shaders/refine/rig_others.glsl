// A rig's depth map and the other rigs that see the same places; inputs and uniforms are set by
// MultiViewRefinement::set_others.
#include "for_others.glsl"
#include "tolerances.glsl"
#include "colour_difference.glsl"

uniform sampler2D depth_map;             // this rig's, metres, 0 = unknown
uniform sampler2D picture;               // this rig's
uniform float spread;                    // relative uncertainty of this rig's depth, per metre of depth
uniform sampler2D other_depth[OTHERS];   // metres, 0 = unknown
uniform sampler2D other_colour[OTHERS];
uniform mat4 other_from_pixel[OTHERS];   // the other's (u * z, v * z, z, 1) from this depth map's
uniform vec2 other_size[OTHERS];         // of its picture, px
uniform float other_spread[OTHERS];

// Projects a pixel of this depth map at depth z into another rig's picture: where it lies there, 0 to 1, and its depth
// from there. False where it is behind the other camera or outside its picture.
bool project(int i, vec2 pixel, float z, out vec2 uv, out float other_z) {
    vec4 q = other_from_pixel[i] * vec4(pixel * z, z, 1.0);
    other_z = q.z;
    if (q.z <= 0.0) return false;
    uv = (q.xy / q.z + 0.5) / other_size[i];
    vec2 inside = min(uv, 1.0 - uv);
    return min(inside.x, inside.y) >= 0.0;
}

// Relative depth within which a surface of the other rig and one of this rig are one surface.
float surface_tolerance(int i, float other_z, float z, float sigmas) {
    return surface_share + sigmas * (other_spread[i] * other_z + spread * z);
}

// Whether all four of the other rig's depths around a place lie before it, so that the rig cannot see it.
bool is_hidden(int i, vec4 around, float other_z, float z) {
    float tolerance = surface_tolerance(i, other_z, z, surface_sigmas);
    return all(lessThan(around, vec4(other_z * (1.0 - tolerance)))) && all(greaterThan(around, vec4(0.0)));
}
