// The virtual stage: texture x light, and on glossy parts the
// highlight of the key light and the reflected surroundings. Textures and picture are coded with gamma 2.
#ifndef SHADOW
#define SHADOW 2
#endif
#ifndef GLOSSY
#define GLOSSY 0
#endif
precision highp sampler2DShadow;

in vec3 texture_at;
in vec3 steady_light;
#if SHADOW == 2
in vec3 key_light;
in vec3 shadow_at;
uniform sampler2DShadow shadow_map;
#endif
#if GLOSSY
in vec3 world_m;
in vec3 world_normal;
in vec2 gloss_and_mirror;

uniform vec3 eye_m;
uniform vec3 key_direction, key_colour;
uniform vec3 sky_colour, ground_colour;
#endif

uniform sampler2DArray textures;

layout(location = 0) out vec4 colour;

#if GLOSSY
// A rough picture of the studio as a mirror sees it: floor, walls with lit columns, ceiling with lamps.
vec3 surroundings(vec3 d) {
    // cos(4a) and cos(8a) of the azimuth a, from cos(a)^2.
    float c1 = d.z * d.z / max(dot(d.xz, d.xz), 1e-6);
    float cos2 = 2.0 * c1 - 1.0;
    float cos4 = 2.0 * cos2 * cos2 - 1.0;
    float cos8 = 2.0 * cos4 * cos4 - 1.0;
    vec3 wall = mix(sky_colour, vec3(0.16, 0.30, 0.38), 0.6);
    wall += smoothstep(0.45, 0.15, abs(cos8)) * smoothstep(0.5, 0.3, d.y) * vec3(0.9, 0.62, 0.34);
    float lamps = smoothstep(0.10, 0.05, abs(d.y - 0.62)) * smoothstep(0.80, 0.95, abs(cos4));
    vec3 ceiling = vec3(0.05, 0.07, 0.12) + lamps * vec3(3.0, 2.8, 2.5);
    vec3 above = mix(wall, ceiling, smoothstep(0.42, 0.50, d.y));
    vec3 floor_colour = ground_colour * vec3(0.9, 0.62, 0.42);
    return mix(floor_colour, above, smoothstep(-0.10, -0.02, d.y));
}
#endif

// A film-like curve (Narkowicz 2015): deep colours stay, highlights roll off.
vec3 display(vec3 light) {
    vec3 c = light * 0.72;
    return sqrt(clamp((c * (2.51 * c + 0.03)) / (c * (2.43 * c + 0.59) + 0.14), 0.0, 1.0));
}

void main() {
    vec3 surface = texture(textures, texture_at).rgb;
    surface *= surface;
#if SHADOW == 2
    float lit = texture(shadow_map, shadow_at);
    vec3 light = surface * (steady_light + lit * key_light);
#else
    float lit = 1.0;
    vec3 light = surface * steady_light;
#endif
#if GLOSSY
    vec3 normal = normalize(world_normal);
    vec3 to_eye = normalize(eye_m - world_m);
    vec3 halfway = normalize(to_eye + key_direction);
    float highlight = pow(max(dot(normal, halfway), 0.0), 90.0);
    float grazing = pow(1.0 - max(dot(normal, to_eye), 0.0), 4.0);
    float mirror = mix(gloss_and_mirror.y, 1.0, grazing * gloss_and_mirror.y);
    light = mix(light, surroundings(reflect(-to_eye, normal)), mirror);
    light += lit * highlight * gloss_and_mirror.x * 2.0 * key_colour;
#endif
    colour = vec4(display(light), 1.0);
}
