// The silhouettes of the foreground in the other rigs. Foreground lies inside the silhouettes of all rigs that look at it
// (the visual hull of Laurentini, 1994).
#include "for_others.glsl"
#include "tolerances.glsl"

#if OTHERS
uniform sampler2D other_matte[OTHERS];   // the foreground's share of each pixel
uniform sampler2D other_background[OTHERS];     // depth of their backgrounds, metres
uniform mat4 other_from_pixel[OTHERS];   // the other's (u * z, v * z, z, 1) from this depth map's
uniform vec2 other_size[OTHERS];         // of its image, px

// 1: the other rig sees foreground at the point; -1: it sees its background there; 0: it does not see the point.
int look_at_silhouette(int i, sampler2D its_matte, sampler2D its_background, vec2 pixel, float z) {
    vec4 q = other_from_pixel[i] * vec4(pixel * z, z, 1.0);
    if (q.z <= 0.0) return 0;
    vec2 texel = 1.0 / other_size[i], uv = (q.xy / q.z + 0.5) * texel;
    vec2 inside = min(uv, 1.0 - uv);
    if (min(inside.x, inside.y) < 0.0) return 0;
    vec4 share = textureGather(its_matte, uv, 0);
    if (max(max(share.x, share.y), max(share.z, share.w)) > 0.0) return 1;
    return textureLod(its_background, uv, 0.0).r > hiding_share * q.z ? -1 : 0;
}
#endif

// Returns how many other rigs see foreground at the point; -1 if one sees its background there.
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
