// What a rig's picture shows at each pixel against its set, which stands still and lies behind everything that moves
// over it. The set's depth of the instants before counts as the rig's matcher sees it, errors and all, and as the model
// has it: on a plain floor the former may be as near as a performer.
#include "colour_change.glsl"
#include "depth_weights.glsl"
#include "background_kinds.glsl"
#include "background_known.glsl"
#include "background_now.glsl"
#include "two_stages.glsl"

#ifndef SAME_SIZE
#define SAME_SIZE 0  // 1: the depth map is as large as the picture
#endif

uniform sampler2D depth_map;  // this instant's, metres, 0 = unknown
uniform sampler2D picture;    // this instant's
uniform sampler2D background_colour; // mean of the instants that showed the set; alpha: how many

layout(location = 0) out vec4 seen;  // red: one of the kinds of background_kinds.glsl; green: how far the colour is from the set's, in a
                                      // window; blue: just here

const float quiet = 0.012;   // of colour (0..1) just here: the set, whatever is around
const float motion = 0.02;   // of colour (0..1), mean of a window: it shows another thing
const vec2 shade = vec2(0.45, 1.3);  // what light and shadow make of a colour, from and to
const float tint = 0.025;            // change of colour beside that
const float uncovered_after = 3.0;   // instants, at most, after which what is farther is the set

vec3 now, known;  // just here, then means of a window

// Seventeen pixels of five by five: the middle and two by two at each corner.
void look_around(vec2 uv) {
    vec2 texel = 1.0 / vec2(textureSize(picture, 0));
    for (int k = 0; k < 4; ++k) {
        vec2 corner = uv + 1.5 * texel * (2.0 * vec2(k & 1, k >> 1) - 1.0);
        now += 4.0 * textureLod(picture, corner, 0.0).rgb;
        known += 4.0 * textureLod(background_colour, corner, 0.0).rgb;
    }
    now /= 17.0;
    known /= 17.0;
}

bool is_shade() {
    float share = dot(now, known) / max(dot(known, known), 1e-4);
    return share > shade.x && share < shade.y && largest(now - share * known) < tint;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    seen = vec4(0.0);
    leave_to_second(false);
    if (has_before == 0.0) return;
    vec2 uv = gl_FragCoord.xy / vec2(textureSize(depth_map, 0));
#if SAME_SIZE
    now = texelFetch(picture, at, 0).rgb;
    vec4 mean = texelFetch(background_colour, at, 0);
#else
    now = textureLod(picture, uv, 0.0).rgb;
    vec4 mean = textureLod(background_colour, uv, 0.0);
#endif
    known = mean.rgb;
    float own = largest(now - known);
    seen = vec4(the_set, 0.5 * own, own, 0.0);
#if FIRST
    leave_to_second(own >= quiet);
#else
    look_around(uv);
    float z = texelFetch(depth_map, at, 0).r, change = largest(now - known);
    vec4 state = texelFetch(background_state, at, 0);
    bool is_known = z > 0.0 && state.r > 0.0, is_same = is_known && is_one_surface(z, state.r);
    float kind = the_set;
    if (change > motion) {
        bool goes_on = state.b > 0.0 && is_one_surface(z, state.b);
        bool restless = is_restless(mean);
        bool is_believed = restless || state.r <= 0.0 || (goes_on ? state.a + 1.0 : 1.0) >= min(state.g, uncovered_after);
        float model_m = background_depth_m(at, state);
        bool is_before = (!is_same && z < state.r) || (z < model_m && !is_one_surface(z, model_m));
        kind = is_same && is_shade()                ? lit_background
               : is_known && !restless && is_before ? before_background
               : z > 0.0 && !is_same                ? (is_believed ? new_background : uncovered)
                                                    : untold;
    }
    seen = vec4(kind, change, own, 0.0);
#endif
}
