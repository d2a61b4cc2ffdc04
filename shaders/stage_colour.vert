// The virtual stage, lit per vertex by all lights but the key's shadow.
#include "stage_transform.glsl"

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
out vec3 key_light;
out vec3 shadow_at;
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
    key_light = key_colour * (max(dot(normal, key_direction), 0.0) * pool);
    // Wrapped, so that the side away from the fill is not flat.
    float fill = max(0.6 * dot(normal, fill_direction) + 0.4, 0.0);
    steady_light = mix(ground_colour, sky_colour, 0.5 * normal.y + 0.5) + fill_colour * fill +
                   rim_colour * max(dot(normal, rim_direction), 0.0);
    steady_light += 1.6 * gloss_mirror_glow.z;
    vec3 tint = tint_and_layer.rgb * tint_and_layer.rgb;
    key_light *= tint;
    steady_light *= tint;

    texture_at = vec3(uv, tint_and_layer.a * 255.0);
    // Looked up a little outside the surface, against shadows on itself.
    shadow_at = (shadow_from_world * vec4(world + 0.025 * normal, 1.0)).xyz * 0.5 + 0.5;
#if GLOSSY
    world_m = world;
    world_normal = normal;
    gloss_and_mirror = gloss_mirror_glow.xy;
#endif
}
