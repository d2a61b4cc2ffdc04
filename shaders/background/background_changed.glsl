// Whether a rig's background looks different from when its model was made. A matcher's depth of a plain surface varies
// while nothing changes, so that a change is one of depth and of colour.
#include "colour_difference.glsl"
#include "tolerances.glsl"

uniform sampler2D depth_then;   // the learnt depth by then, metres, 0 = unknown
uniform sampler2D colour_then;  // of the background by then
uniform float spread;           // relative uncertainty of depth, per metre of depth

const vec2 light = vec2(0.4, 2.5);  // change of light, least and greatest factor
const float max_change = 0.12;      // of a colour beside that

bool has_background_changed(float depth_m, vec3 colour, vec2 uv) {
    float then = textureLod(depth_then, uv, 0.0).r;
    if (abs(depth_m - then) <= depth_m * (surface_share + surface_sigmas * spread * depth_m)) return false;
    vec3 before = textureLod(colour_then, uv, 0.0).rgb;
    const vec3 mean = vec3(1.0 / 3.0);
    float brighter = clamp(dot(colour, mean) / max(dot(before, mean), 0.01), light.x, light.y);
    return largest(colour - brighter * before) > max_change;
}
