// Classifies each pixel of a rig's picture against its background, which stands still behind everything that moves. Depth
// is compared both with the mean of the rig's own matcher, whose errors repeat, and with the refined model: on a plain
// floor the matcher's depth may be as near as a performer.
#include "colour_difference.glsl"
#include "depth_weights.glsl"
#include "background_kinds.glsl"
#include "background_known.glsl"
#include "background_now.glsl"
#include "two_stages.glsl"
#include "tolerances.glsl"

#ifndef SAME_SIZE
#define SAME_SIZE 0  // 1: the depth map is as large as the picture
#endif

uniform sampler2D depth_map;  // this instant's, metres, 0 = unknown
uniform sampler2D picture;    // this instant's
uniform sampler2D background_colour; // mean of the instants that showed the background; alpha: their number

layout(location = 0) out vec4 seen;  // red: a kind of background_kinds.glsl; green: change of colour in a window; blue: of the pixel

const float max_quiet_change = 0.012;           // change of the pixel's colour below which it shows the background
const vec2 shade = vec2(0.45, 1.3);  // least and greatest factor that shadow and light apply to a colour
const float max_tint = 0.025;            // change of colour that remains beside that factor, at most
const float uncovered_after = 3.0;   // instants, at most, after which a farther surface becomes the background

vec3 now, known;  // colour and background colour of the pixel, later means of a window

// Averages seventeen of five by five pixels: the middle and two by two at each corner.
void average_window(vec2 uv) {
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
    return share > shade.x && share < shade.y && largest(now - share * known) < max_tint;
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
    seen = vec4(the_background, 0.5 * own, own, 0.0);
#if FIRST
    leave_to_second(own >= max_quiet_change);
#else
    average_window(uv);
    float z = texelFetch(depth_map, at, 0).r, change = largest(now - known);
    vec4 state = texelFetch(background_state, at, 0);
    bool is_known = z > 0.0 && state.r > 0.0, is_same = is_known && is_one_surface(z, state.r);
    float kind = the_background;
    if (change > motion_change) {
        bool goes_on = state.b > 0.0 && is_one_surface(z, state.b);
        bool restless = is_restless(mean);
        bool is_believed = restless || state.r <= 0.0 || (goes_on ? state.a + 1.0 : 1.0) >= min(state.g, uncovered_after);
        float model_m = background_depth_m(at, state);
        bool is_before = (!is_same && z < state.r) || (z < model_m && !is_one_surface(z, model_m));
        kind = is_same && is_shade()                ? lit_background
               : is_known && !restless && is_before ? before_background
               : z > 0.0 && !is_same                ? (is_believed ? new_background : uncovered)
                                                    : undecided;
    }
    seen = vec4(kind, change, own, 0.0);
#endif
}
