// Puts pixels on the stage's floor where the other rigs' pictures match there as well as at the pixel's own depth. A plain
// floor looks the same at every depth, and a matcher takes it for the objects that stand on it.
#include "rig_others.glsl"

#define WINDOW 9
const int window_middle = 4;
const float window_px = 1.5;  // from the middle to the sides of the window
vec2 aside(int k) { return window_px * vec2(k % 3 - 1, k / 3 - 1); }
#include "rig_window.glsl"

uniform sampler2D before;  // metres, 0 = unknown, negative = inpainted
uniform vec3 floor_plane;  // inverse depth per (u, v, 1) of the depth map

layout(location = 0) out float with_floor;

const float max_extra_cost = 0.01;   // by which the floor's cost may exceed that of the pixel's own depth
const float certain_floor = 0.06;    // cost of the floor below which it is accepted far from the pixel's own depth
const float near_sigmas = 2.0;       // deviations of a measured depth within which it is near the floor
const float horizon = 1e-3;          // inverse depth of the floor, 1/m, below which it is too far away to be seen

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 pixel = vec2(at);
    float own = texelFetch(before, at, 0).r, floor_inverse_m = dot(floor_plane, vec3(pixel, 1.0));
    with_floor = own;
    if (own <= 0.0 || floor_inverse_m < horizon) return;
#ifdef WITHOUT_FLOOR  // tests/bench/step_worth.py
    return;
#endif
    read_window(pixel, textureSize(depth_map, 0));
    float on_floor = cost_on(pixel, floor_plane);
    if (on_floor > certain_floor && abs(floor_inverse_m - 1.0 / own) > near_sigmas * spread) return;
    if (on_floor < cost_at(pixel, own) + max_extra_cost) with_floor = 1.0 / floor_inverse_m;
}
