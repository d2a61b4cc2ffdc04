// Samples on a coarse grid whether a rig's background is known (red), its matte (green), and whether the background looks
// different from when its model was made (blue). A matcher's depth of a plain surface wavers while nothing changes, so that
// a change is one of depth and of colour.
#include "background_known.glsl"
#include "colour_difference.glsl"
#include "tolerances.glsl"

uniform sampler2D background_state;   // from background_learn.frag
uniform sampler2D background_colour;  // the mean of background_colour.frag
uniform sampler2D matte;              // from matte_edges.frag
uniform sampler2D depth_then;         // the state's depth that the model was made from, metres, 0 = unknown
uniform sampler2D colour_then;        // of the background by then
uniform float spread;                 // relative uncertainty of depth, per metre of depth
uniform vec2 sample_share;            // of the picture, from one sample to the next

layout(location = 0) out vec4 seen;

const vec2 light = vec2(0.4, 2.5);  // change of light, least and greatest factor
const float max_change = 0.12;      // of a colour beside that

bool has_changed(vec4 state, vec3 colour, vec2 uv) {
    float then = textureLod(depth_then, uv, 0.0).r;
    if (abs(state.r - then) <= state.r * (surface_share + surface_sigmas * spread * state.r)) return false;
    vec3 before = textureLod(colour_then, uv, 0.0).rgb;
    const vec3 mean = vec3(1.0 / 3.0);
    float brighter = clamp(dot(colour, mean) / max(dot(before, mean), 0.01), light.x, light.y);
    return largest(colour - brighter * before) > max_change;
}

void main() {
    vec2 share = gl_FragCoord.xy * sample_share;
    vec4 state = textureLod(background_state, share, 0.0), mean = textureLod(background_colour, share, 0.0);
    bool is_known = is_background_known(state, mean);
    seen = vec4(is_known ? 1.0 : 0.0, textureLod(matte, share, 0.0).r,
                is_known && has_changed(state, mean.rgb, share) ? 1.0 : 0.0, 0.0);
}
