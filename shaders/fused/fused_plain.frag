// The colour of the virtual view on the surface of fused_depth.frag at low cost: every rig whose depth map has the
// surface contributes its colour, weighted by the angle of its line of sight to the virtual camera's and by its
// confidence. Depth edges are as hard as in the depth maps.
#ifndef LAYERS
#define LAYERS 2
#endif
#include "rig_layers.glsl"

uniform sampler2D fused_depth;  // metres, 0 = nothing, negative = inpainted
uniform float softness;         // relative depth within which two surfaces are one

layout(location = 0) out vec4 fused;
layout(location = 1) out float fused_z;

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
    vec4 seen = textureLod(picture, uv, lod);
    float away = apart(ray_from_pixel * vec3(pixel, 1.0) * z, centre[i]);
    float w = presence[i] * sure * (seen.a + 0.001) * (smoothstep(0.0, 0.04, inside) + 0.001) / (away + 1e-5);
    sum += w * seen.rgb;
    weight += w;
    shares[i] += w;
    confidence = max(confidence, seen.a);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float own = texelFetch(fused_depth, at, 0).r, z = abs(own);
    fused = vec4(0.0);
    fused_z = 0.0;
    tell_origins(vec4(0.0));
    if (z == 0.0) return;
    vec3 sum = vec3(0.0);
    vec4 shares = vec4(0.0);
    float weight = 0.0, confidence = 0.0;
#define ADD(i) add(i, colour[i], source_depth[i], vec2(at), z, sum, weight, shares, confidence);
    FOR_LAYERS(ADD)
    if (weight == 0.0) return;
    fused = vec4(sum / weight, alpha_of(own > 0.0, confidence));
    fused_z = z;
    tell_origins(shares / weight);
}
