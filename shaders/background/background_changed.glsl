// Whether a rig's background looks as it did when its model was made or its stereo began. A matcher's depth of a plain
// surface varies while nothing changes, so that a change is one of depth and of colour.
#include "colour_difference.glsl"
#include "tolerances.glsl"

uniform sampler2D depth_then;   // the learnt depth by then, metres, 0 = unknown; may be of a smaller size
uniform sampler2D colour_then;  // of the background by then
uniform float spread;           // relative uncertainty of depth, per metre of depth

const vec2 light = vec2(0.4, 2.5);  // change of light, least and greatest factor
const float max_change = 0.12;      // of a colour beside that

bool is_depth_as_then(float depth_m, vec2 uv) {
    float then = textureLod(depth_then, uv, 0.0).r;
    return abs(depth_m - then) <= depth_m * (surface_share + surface_sigmas * spread * depth_m);
}

bool is_colour_as_then(vec3 colour, vec2 uv) {
    vec3 before = textureLod(colour_then, uv, 0.0).rgb;
    const vec3 mean = vec3(1.0 / 3.0);
    float brighter = clamp(dot(colour, mean) / max(dot(before, mean), 0.01), light.x, light.y);
    return largest(colour - brighter * before) <= max_change;
}

bool has_background_changed(float depth_m, vec3 colour, vec2 uv) {
    return !is_depth_as_then(depth_m, uv) && !is_colour_as_then(colour, uv);
}
