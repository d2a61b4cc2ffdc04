// The silhouettes of rigs, for the visual hull of what stands before their backgrounds.
#include "tolerances.glsl"
#ifndef RIGS
#define RIGS 4
#endif

uniform sampler2D matte[RIGS];           // the performers' share of a rig's pixels
uniform sampler2D background_depth[RIGS];       // metres, 0 = unknown
uniform mat4 pixel_from_target[RIGS];    // the rigs' (u * z, v * z, z, 1) from the virtual camera's
uniform vec2 picture_size[RIGS];         // px

// Runs X(0), X(1), ... for every rig: samplers take constant indices only.
#if RIGS == 1
#define FOR_RIGS(X) X(0)
#elif RIGS == 2
#define FOR_RIGS(X) X(0) X(1)
#elif RIGS == 3
#define FOR_RIGS(X) X(0) X(1) X(2)
#else
#define FOR_RIGS(X) X(0) X(1) X(2) X(3)
#endif

const int least_rigs = min(RIGS, 3);  // that have to see a point: in what two see silhouettes meet by chance

// 1: the point is in the rig's silhouette; 0: it is not; -1: the rig cannot tell.
int in_silhouette(int i, sampler2D its_matte, sampler2D its_background, vec4 target_point) {
    vec4 q = pixel_from_target[i] * target_point;
    if (q.z <= 0.0) return -1;
    vec2 uv = (q.xy / q.z + 0.5) / picture_size[i];
    vec2 inside = min(uv, 1.0 - uv);
    if (min(inside.x, inside.y) < 0.0) return -1;
    if (textureLod(its_matte, uv, 0.0).r >= 0.5) return 1;
    float behind = textureLod(its_background, uv, 0.0).r;
    return behind > 0.0 && behind < hiding_share * q.z ? -1 : 0;
}

// Whether a point of the virtual camera's (u * z, v * z, z, 1) lies in the hull: in all silhouettes that can tell.
bool in_hull(vec4 target_point) {
    int rigs = 0, told;
#define TELL(i)                                                               \
    told = in_silhouette(i, matte[i], background_depth[i], target_point);            \
    if (told == 0) return false;                                              \
    rigs += max(told, 0);
    FOR_RIGS(TELL)
    return rigs >= least_rigs;
}
