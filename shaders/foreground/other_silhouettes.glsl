// The silhouettes of other rigs' performers: what stands before the set stands in those of all rigs that look there (the
// visual hull of Laurentini, 1994).
#include "for_others.glsl"

#if OTHERS
uniform sampler2D other_matte[OTHERS];   // their performers' share
uniform sampler2D other_background[OTHERS];     // depth of their sets, metres
uniform mat4 other_from_pixel[OTHERS];   // the other's (u * z, v * z, z, 1) from this depth map's
uniform vec2 other_size[OTHERS];         // of its picture, px

const float hidden = 0.95;  // a set nearer than this share of a point's depth hides it

// 1: the other rig sees a performer where the point would be; -1: it sees its set there; 0: it cannot tell.
int look_at_silhouette(int i, sampler2D its_matte, sampler2D its_set, vec2 pixel, float z) {
    vec4 q = other_from_pixel[i] * vec4(pixel * z, z, 1.0);
    if (q.z <= 0.0) return 0;
    vec2 texel = 1.0 / other_size[i], uv = (q.xy / q.z + 0.5) * texel;
    vec2 inside = min(uv, 1.0 - uv);
    if (min(inside.x, inside.y) < 0.0) return 0;
    vec4 share = textureGather(its_matte, uv, 0);
    if (max(max(share.x, share.y), max(share.z, share.w)) > 0.0) return 1;
    return textureLod(its_set, uv, 0.0).r > hidden * q.z ? -1 : 0;
}
#endif

// How many other rigs see a performer where the point would be; -1 if one sees its set there.
int look_at_silhouettes(vec2 pixel, float z) {
    int all = 0;
#if OTHERS
    int its;
#define LOOK(i)                                                              \
    its = look_at_silhouette(i, other_matte[i], other_background[i], pixel, z);     \
    if (its < 0) return -1;                                                  \
    all += its;
    FOR_OTHERS(LOOK)
#endif
    return all;
}
