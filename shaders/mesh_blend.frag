// Merges the rigs' meshes, each drawn alone to its depth buffer: at every pixel the surfaces within a soft distance
// of the nearest one are blended, weighted by how close each rig's line of sight is to the virtual camera's, so that
// neighbouring meshes melt into each other where z-fighting would make them flicker.
#ifndef LAYERS
#define LAYERS 4
#endif

uniform sampler2D depth[LAYERS];   // 1 - near / z, 1 = nothing
uniform sampler2D colour[LAYERS];
uniform mat4 pixel_from_target[LAYERS];  // on (x * z, y * z, z, 1)
uniform vec3 centre[LAYERS];             // of the rig's camera, in the virtual camera's coordinates
uniform float spread[LAYERS];            // uncertainty of depth: relative, per metre of depth
uniform mat3 ray_from_pixel;             // of the virtual camera
uniform float near_m;
uniform float softness;                  // relative depth within which two surfaces are one

layout(location = 0) out vec4 blended;
layout(location = 1) out float blended_z;

const float nothing = 1e30;

float layer_z(sampler2D map, ivec2 at) {
    float d = texelFetch(map, at, 0).r;
    return d < 1.0 ? near_m / (1.0 - d) : nothing;
}

void add_layer(int i, sampler2D picture, float z, float nearest, vec2 pixel, vec3 ray, inout vec4 sum,
               inout float sum_z) {
    float tolerance = softness + spread[i] * nearest;
    float visible = 1.0 - smoothstep(1.0, 2.0, (z / nearest - 1.0) / tolerance);
    if (visible <= 0.0) return;
    vec4 q = pixel_from_target[i] * vec4(pixel * z, z, 1.0);
    vec2 size = vec2(textureSize(picture, 0));
    vec2 uv = (q.xy / q.z + 0.5) / size;
    vec2 margin = min(uv, 1.0 - uv);
    float inside = smoothstep(0.0, 0.04, min(margin.x, margin.y)) + 0.001;
    vec3 point = ray * z;
    vec3 to_rig = point - centre[i];
    float apart = 1.0 - dot(normalize(point), normalize(to_rig));
    float weight = visible * inside / (apart + 1e-5);
    // Source pixels to a pixel of the target, from how depth and focal length scale.
    float lod = log2(max(length(pixel_from_target[i][0].xyz) * z / q.z, 1.0));
    sum += weight * vec4(textureLod(picture, uv, lod).rgb, 1.0);
    sum_z += weight * z;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 pixel = vec2(at);
    float z[LAYERS];
    float nearest = nothing;
#define LOOK(i) z[i] = layer_z(depth[i], at); nearest = min(nearest, z[i]);
    LOOK(0)
#if LAYERS > 1
    LOOK(1)
#endif
#if LAYERS > 2
    LOOK(2)
#endif
#if LAYERS > 3
    LOOK(3)
#endif
    if (nearest == nothing) {
        blended = vec4(0.0);
        blended_z = 0.0;
        return;
    }
    vec3 ray = ray_from_pixel * vec3(pixel, 1.0);
    vec4 sum = vec4(0.0);
    float sum_z = 0.0;
#define ADD(i) add_layer(i, colour[i], z[i], nearest, pixel, ray, sum, sum_z);
    ADD(0)
#if LAYERS > 1
    ADD(1)
#endif
#if LAYERS > 2
    ADD(2)
#endif
#if LAYERS > 3
    ADD(3)
#endif
    blended = vec4(sum.rgb / sum.a, 1.0);
    blended_z = sum_z / sum.a;
}
