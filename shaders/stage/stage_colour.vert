// The virtual stage, lit per vertex but for sharp shadows.
#include "stage_transform.glsl"

// Where the key light's shadow is looked up: 0 nowhere, 1 at the vertices, 2 at every pixel.
#ifndef SHADOW
#define SHADOW 2
#endif
#ifndef GLOSSY
#define GLOSSY 0
#endif

layout(location = 1) in vec2 uv;
layout(location = 3) in vec4 tint_and_layer;
layout(location = 4) in vec4 gloss_mirror_glow;

uniform mat4 clip_from_world;
uniform mat4 shadow_from_world;
uniform vec3 key_direction, key_colour;
uniform vec3 fill_direction, fill_colour;
uniform vec3 rim_direction, rim_colour;
uniform vec3 sky_colour, ground_colour;

out vec3 texture_at;
out vec3 steady_light;
#if SHADOW == 1
precision highp sampler2DShadow;
uniform sampler2DShadow shadow_map;
#endif
#if SHADOW == 2
out vec3 key_light;
out vec3 shadow_at;
#endif
#if GLOSSY
out vec3 world_m;
out vec3 world_normal;
out vec2 gloss_and_mirror;
#endif

void main() {
    vec3 world = to_world(vec4(position_m, 1.0));
    vec3 normal = normalize(to_world(vec4(vec3(normal_and_bone.xyz), 0.0)));
    gl_Position = clip_from_world * vec4(world, 1.0);

    // The middle of the stage lies in the pool of the key light.
    float pool = 0.45 + 0.55 * smoothstep(5.5, 1.5, length(world.xz));
    vec3 key = key_colour * (max(dot(normal, key_direction), 0.0) * pool);
    // Wrapped, so that the side away from the fill is not flat.
    float fill = max(0.6 * dot(normal, fill_direction) + 0.4, 0.0);
    steady_light = mix(ground_colour, sky_colour, 0.5 * normal.y + 0.5) + fill_colour * fill +
                   rim_colour * max(dot(normal, rim_direction), 0.0);
    steady_light += 1.6 * gloss_mirror_glow.z;
    vec3 tint = tint_and_layer.rgb * tint_and_layer.rgb;
    key *= tint;
    steady_light *= tint;

    texture_at = vec3(uv, tint_and_layer.a * 255.0);
#if SHADOW == 0
    steady_light += key;
#else
    // Looked up a little outside the surface, against shadows on itself.
    vec3 at = (shadow_from_world * vec4(world + 0.025 * normal, 1.0)).xyz * 0.5 + 0.5;
#if SHADOW == 1
    steady_light += key * textureLod(shadow_map, at, 0.0);
#else
    key_light = key;
    shadow_at = at;
#endif
#endif
#if GLOSSY
    world_m = world;
    world_normal = normal;
    gloss_and_mirror = gloss_mirror_glow.xy;
#endif
}
