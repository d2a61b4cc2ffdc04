// The colour of the virtual view on the surface of fused_depth.frag at low cost: every rig whose depth map has the
// surface contributes its colour, weighted by the angle of its line of sight to the virtual camera's and by its
// confidence. Depth edges are as hard as in the depth maps.
#ifndef LAYERS
#define LAYERS 2
#endif
#ifndef BAKED
#define BAKED 0  // 1: on a baked background, which has the colours that no rig shows, and behind a foreground
#endif
#include "rig_layers.glsl"
#include "tolerances.glsl"

uniform sampler2D fused_depth;  // metres, 0 = nothing, negative = inpainted
#if BAKED
uniform sampler2D baked_colour;      // alpha is below one half where the place was never seen
uniform sampler2D foreground;        // premultiplied by alpha
uniform sampler2D foreground_depth;  // metres, 0 = none
#if ORIGINS
uniform sampler2D foreground_shares;
#endif
#endif
uniform float softness;         // relative depth within which two surfaces are one

layout(location = 0) out vec4 fused;
layout(location = 1) out float fused_z;

const int past_steps = 3;  // from such a surface to the one that the rig sees
const float typical = 100.0;  // the scene's typical depth, relative to the near plane's

void add(int i, sampler2D picture, sampler2D map, vec2 pixel, float z, inout vec3 sum, inout float weight, inout vec4 shares,
         inout float confidence) {
    vec4 q = pixel_from_target[i] * vec4(pixel * z, z, 1.0);
    if (q.z <= 0.0) return;
    vec2 uv = (q.xy / q.z + 0.5) / colour_size[i];
    vec2 margin = min(uv, 1.0 - uv);
    float inside = min(margin.x, margin.y);
    if (inside < 0.0) return;
    vec4 off = abs(abs(textureGather(map, uv)) / q.z - 1.0);
    float nearest = min(min(off.x, off.y), min(off.z, off.w));
    float tolerance = softness + spread[i] * q.z;
    float sure = 1.0 - smoothstep(1.0, 2.0, nearest / tolerance);
    if (sure <= 0.0) return;
    float lod = detail_level(pixel_from_target[i], z, q.z);
#if BAKED
    lod = floor(lod + 0.5);  // a software rasteriser then reads one level instead of two
#endif
    vec4 seen = textureLod(picture, uv, lod);
    float away = apart(ray_from_pixel * vec3(pixel, 1.0) * z, centre[i]);
    float w = presence[i] * sure * (seen.a + 0.001) * (smoothstep(0.0, 0.04, inside) + 0.001) / (away + 1e-5);
    sum += w * seen.rgb;
    weight += w;
    shares[i] += w;
    confidence = max(confidence, seen.a);
}

#if BAKED
// Where a rig sees past a surface at depth z, which no rig has any more, shows what that rig sees there: it sees past
// where its own depth is at least a share of the surface's. Returns false where it does not.
bool show_past(int i, sampler2D picture, sampler2D map, vec2 pixel, float z, float share) {
    vec2 uv;
    for (int k = 0; k < past_steps; ++k) {
        vec4 q = pixel_from_target[i] * vec4(pixel * z, z, 1.0);
        uv = (q.xy / q.z + 0.5) / colour_size[i];
        vec2 margin = min(uv, 1.0 - uv);
        if (q.z <= 0.0 || min(margin.x, margin.y) < 0.0) return false;
        float there = abs(textureLod(map, uv, 0.0).r);
        if (there <= 0.0 || (k == 0 && there < share * q.z)) return false;
        z *= there / q.z;
    }
    fused = vec4(textureLod(picture, uv, 0.0).rgb, 1.0);
    fused_z = z;
    vec4 shares = vec4(0.0);
    shares[i] = 1.0;
    tell_origins(shares);
    return true;
}
#endif

// Shows what the first rig sees that sees past a surface at depth z (see show_past); only with BAKED.
void show_what_rigs_see(vec2 pixel, float z, float share) {
#if BAKED
    bool is_shown = false;
#define SHOW_FROM(i) is_shown = is_shown || show_past(i, colour[i], source_depth[i], pixel, z, share);
    FOR_LAYERS(SHOW_FROM)
#endif
}

void show_background(ivec2 at) {
    float own = texelFetch(fused_depth, at, 0).r, z = abs(own);
    fused = vec4(0.0);
    fused_z = 0.0;
    tell_origins(vec4(0.0));
#if BAKED
    fused = texelFetch(baked_colour, at, 0);
    fused_z = own;
#endif
    if (z == 0.0) {
        show_what_rigs_see(vec2(at), typical * near_m, 0.0);  // no probe reaches here
        return;
    }
    vec3 sum = vec3(0.0);
    vec4 shares = vec4(0.0);
    float weight = 0.0, confidence = 0.0;
#define ADD(i) add(i, colour[i], source_depth[i], vec2(at), z, sum, weight, shares, confidence);
    FOR_LAYERS(ADD)
    if (weight == 0.0) {
        show_what_rigs_see(vec2(at), z, 1.0 + view_edge_share);
        return;
    }
    fused = vec4(sum / weight, alpha_of(own > 0.0, confidence));
    fused_z = z;
    tell_origins(shares / weight);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    show_background(at);
#if BAKED
    vec4 before = texelFetch(foreground, at, 0);
    fused.rgb = before.rgb + (1.0 - before.a) * fused.rgb;
    if (before.a <= 0.5) return;
    fused.a = 1.0;
    fused_z = texelFetch(foreground_depth, at, 0).r;
#if ORIGINS
    tell_origins(texelFetch(foreground_shares, at, 0));
#endif
#endif
}
