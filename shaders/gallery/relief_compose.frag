// Maps the rigs' pre-warped relief textures onto their planes, as ordinary texturing does, and keeps what is nearest;
// surfaces of two rigs that are one are blended by how near their lines of sight are to the virtual camera's.
#ifndef LAYERS
#define LAYERS 4
#endif

uniform sampler2D warped_colour[LAYERS];  // alpha 0 = nothing
uniform sampler2D warped_m[LAYERS];       // depth from the rig
uniform mat3 ray[LAYERS];        // the rig's direction from the virtual camera's pixel
uniform vec3 eye[LAYERS];        // of the virtual camera, in the rig's coordinates
uniform vec4 pinhole[LAYERS];    // focal lengths and principal point, px, of the rig
uniform vec3 plane[LAYERS];      // depth of the plane in metres; margins of the relief along x and y, px
uniform float softness;          // relative depth within which two surfaces are one
uniform float spread[LAYERS];    // relative uncertainty of depth, per metre of depth
uniform float presence[LAYERS];

#if LAYERS == 1
#define FOR_LAYERS(X) X(0)
#elif LAYERS == 2
#define FOR_LAYERS(X) X(0) X(1)
#elif LAYERS == 3
#define FOR_LAYERS(X) X(0) X(1) X(2)
#else
#define FOR_LAYERS(X) X(0) X(1) X(2) X(3)
#endif

layout(location = 0) out vec4 composed;
layout(location = 1) out float composed_z;

const float nothing = 1e30;

// Colour where this pixel's line of sight meets the plane; z: what is seen there, from the virtual camera.
vec4 look(int i, sampler2D its_colour, sampler2D its_m, vec2 pixel, out float z, out float weight) {
    vec3 direction = ray[i] * vec3(pixel, 1.0);
    z = nothing;
    weight = 0.0;
    float to_plane = (plane[i].x - eye[i].z) / direction.z;
    if (!(to_plane > 0.0) || eye[i].z >= plane[i].x) return vec4(0.0);
    vec2 hit = (eye[i].xy + to_plane * direction.xy) / plane[i].x;
    vec2 at = pinhole[i].xy * hit + pinhole[i].zw + plane[i].yz + 0.5;
    vec2 size = vec2(textureSize(its_colour, 0));
    vec2 inside = min(at, size - at);
    if (min(inside.x, inside.y) < 0.0) return vec4(0.0);
    vec4 c = textureLod(its_colour, at / size, 0.0);
    float m = texelFetch(its_m, ivec2(at), 0).r;
    if (c.a < 0.5 || m <= 0.0) return vec4(0.0);
    z = (m - eye[i].z) / direction.z;
    vec3 to_point = z * direction, to_rig = eye[i] + to_point;
    weight = 1.0 / (1.0 - dot(normalize(to_point), normalize(to_rig)) + 1e-5);
    return vec4(c.rgb / c.a, 1.0);
}

void main() {
    vec2 pixel = gl_FragCoord.xy - 0.5;
    vec4 c[LAYERS];
    float z[LAYERS], weight[LAYERS], nearest = nothing;
#define LOOK(i)                                                                        \
    c[i] = look(i, warped_colour[i], warped_m[i], pixel, z[i], weight[i]);             \
    nearest = min(nearest, z[i]);
    FOR_LAYERS(LOOK)
    composed = vec4(0.0);
    composed_z = 0.0;
    if (nearest == nothing) return;
    float sum_z = 0.0;
    vec4 sum = vec4(0.0);
#define ADD(i)                                                                                                     \
    {                                                                                                              \
        float visible = 1.0 - smoothstep(1.0, 2.0, (z[i] / nearest - 1.0) / (softness + spread[i] * nearest));     \
        float w = visible * weight[i] * presence[i];                                                               \
        sum += w * c[i];                                                                                           \
        sum_z += w * min(z[i], 1e6);                                                                               \
    }
    FOR_LAYERS(ADD)
    if (sum.a == 0.0) return;
    composed = vec4(sum.rgb / sum.a, 1.0);
    composed_z = sum_z / sum.a;
}
