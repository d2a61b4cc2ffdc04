// Merges the rigs' meshes, each drawn alone to its depth buffer: at every pixel the surfaces within a soft distance
// of the nearest one are blended, weighted by how close each rig's line of sight is to the virtual camera's, so that
// neighbouring meshes melt into each other where z-fighting would make them flicker.
#include "rig_layers.glsl"

uniform float softness;  // relative depth within which two surfaces are one

layout(location = 0) out vec4 blended;
layout(location = 1) out float blended_z;

void add_layer(int i, sampler2D picture, float z, float nearest, vec2 pixel, vec3 ray, inout vec4 sum,
               inout float sum_z, inout vec4 shares) {
    float tolerance = softness + spread[i] * nearest;
    float visible = 1.0 - smoothstep(1.0, 2.0, (z / nearest - 1.0) / tolerance);
    if (visible <= 0.0) return;
    vec4 q = pixel_from_target[i] * vec4(pixel * z, z, 1.0);
    vec2 uv = (q.xy / q.z + 0.5) / vec2(textureSize(picture, 0));
    vec2 margin = min(uv, 1.0 - uv);
    float inside = smoothstep(0.0, 0.04, min(margin.x, margin.y)) + 0.001;
    float weight = visible * inside / (apart(ray * z, centre[i]) + 1e-5);
    sum += weight * vec4(textureLod(picture, uv, detail_level(pixel_from_target[i], z, q.z)).rgb, 1.0);
    sum_z += weight * z;
    shares[i] += weight;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 pixel = vec2(at);
    float z[LAYERS];
    float nearest = nothing;
#define LOOK(i) z[i] = layer_z(layer_depth[i], at); nearest = min(nearest, z[i]);
    FOR_LAYERS(LOOK)
    tell_origins(vec4(0.0));
    if (nearest == nothing) {
        blended = vec4(0.0);
        blended_z = 0.0;
        return;
    }
    vec3 ray = ray_from_pixel * vec3(pixel, 1.0);
    vec4 sum = vec4(0.0), shares = vec4(0.0);
    float sum_z = 0.0;
#define ADD(i) add_layer(i, colour[i], z[i], nearest, pixel, ray, sum, sum_z, shares);
    FOR_LAYERS(ADD)
    blended = vec4(sum.rgb / sum.a, 1.0);
    blended_z = sum_z / sum.a;
    tell_origins(shares / sum.a);
}
