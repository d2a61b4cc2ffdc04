// Keeps of a rig's performers the depth that all other rigs' mattes allow: what stands before the set stands in the
// silhouettes of all rigs that look there (the visual hull of Laurentini, 1994).
#include "for_others.glsl"
#include "set_kinds.glsl"

uniform sampler2D depth_map;             // this instant's, metres, 0 = unknown
uniform sampler2D seen;                  // from set_see.frag
uniform sampler2D matte;                 // the performers' share
#if OTHERS
uniform sampler2D other_matte[OTHERS];
uniform sampler2D other_set[OTHERS];     // depth of their sets, metres
uniform mat4 other_from_pixel[OTHERS];   // the other's (u * z, v * z, z, 1) from this depth map's
uniform vec2 other_size[OTHERS];         // of its picture, px
#endif

layout(location = 0) out float carved;  // metres, 0 = unknown

#if OTHERS
const float hidden = 0.95;  // a set nearer than this share of a point's depth hides it

// Whether the other rig sees its set where the point would be.
bool is_outside(int i, sampler2D its_matte, sampler2D its_set, vec2 pixel, float z) {
    vec4 q = other_from_pixel[i] * vec4(pixel * z, z, 1.0);
    if (q.z <= 0.0) return false;
    vec2 texel = 1.0 / other_size[i], uv = (q.xy / q.z + 0.5) * texel;
    vec2 inside = min(uv, 1.0 - uv);
    if (min(inside.x, inside.y) < 0.0) return false;
    vec4 share = textureGather(its_matte, uv, 0);
    if (max(max(share.x, share.y), max(share.z, share.w)) > 0.0) return false;
    float behind = textureLod(its_set, uv, 0.0).r;
    return behind > hidden * q.z;
}
#endif

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    carved = 0.0;
    vec2 uv = gl_FragCoord.xy / vec2(textureSize(depth_map, 0));
    float kind = texelFetch(seen, at, 0).r, z = texelFetch(depth_map, at, 0).r;
    if (textureLod(matte, uv, 0.0).r < 0.1 || !is_kind(kind, before_set) || z == 0.0) return;
#define LOOK(i) if (is_outside(i, other_matte[i], other_set[i], vec2(at), z)) return;
    FOR_OTHERS(LOOK)
    carved = z;
}
