// The depth-clipped part of a facet: where the rig's depth map has the surface in the facet's voxel.
uniform sampler2D depth_map;     // metres, 0 = unknown, negative = guessed
uniform mat4 pixel_from_target;  // the depth map's (u * z, v * z, z, 1) from the virtual camera's
uniform float reach_m;           // before and behind the facet that still is the voxel's

flat in float facet_z;

void main() {
    vec2 pixel = gl_FragCoord.xy - 0.5;
    vec4 q = pixel_from_target * vec4(pixel * facet_z, facet_z, 1.0);
    ivec2 at = ivec2(floor(q.xy / q.z + 0.5)), size = textureSize(depth_map, 0);
    if (q.z <= 0.0 || any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) discard;
    if (abs(abs(texelFetch(depth_map, at, 0).r) - q.z) > reach_m) discard;
}
