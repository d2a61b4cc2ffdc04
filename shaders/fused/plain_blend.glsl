// The colour of a surface of the virtual view at low cost: of the rigs whose depth map has the surface, weighted by the
// angle of their line of sight to the virtual camera's and by their confidence.
#include "rig_layers.glsl"

uniform float softness;  // relative depth within which two surfaces are one

struct Blend {
    vec3 sum;
    vec4 shares;  // each layer's part of the weight
    float weight;
    float confidence;  // the largest of a rig's colour
};

// Adds a rig's colour at depth z. `sees` is how well the rig sees the surface, 0..1, as far as that is known.
void add(int i, sampler2D picture, sampler2D map, vec2 pixel, float z, float sees, inout Blend blend) {
    if (sees <= 0.0) return;
    vec4 q = pixel_from_target[i] * vec4(pixel * z, z, 1.0);
    if (q.z <= 0.0) return;
    vec2 uv = (q.xy / q.z + 0.5) / colour_size[i];
    vec2 margin = min(uv, 1.0 - uv);
    float inside = min(margin.x, margin.y);
    if (inside < 0.0) return;
    vec4 off = abs(abs(textureGather(map, uv)) / q.z - 1.0);
    float nearest = min(min(off.x, off.y), min(off.z, off.w));
    sees *= 1.0 - smoothstep(1.0, 2.0, nearest / (softness + spread[i] * q.z));
    if (sees <= 0.0) return;
    // A software rasteriser reads one level instead of two.
    vec4 seen = textureLod(picture, uv, floor(detail_level(pixel_from_target[i], z, q.z) + 0.5));
    float away = apart(ray_from_pixel * vec3(pixel, 1.0) * z, centre[i]);
    float w = presence[i] * sees * (seen.a + 0.001) * (smoothstep(0.0, 0.04, inside) + 0.001) / (away + 1e-5);
    blend.sum += w * seen.rgb;
    blend.shares[i] += w;
    blend.weight += w;
    blend.confidence = max(blend.confidence, seen.a);
}
