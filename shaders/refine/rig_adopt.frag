// Gives pixels whose depth no other rig confirms the depth of a confirmed pixel near them, where the rigs' pictures match
// far better with it. A place that only one of a rig's two cameras sees, or that its matcher took for something else,
// mostly belongs to a surface beside it. A pixel without such a neighbour whose cost is high is marked as inpainted
// (negative).
#include "rig_others.glsl"

#define WINDOW 5
const int window_middle = 0;
const float window_px = 1.0;  // from the middle to the sides of the window
vec2 aside(int k) { return window_px * vec2(int(k == 1) - int(k == 2), int(k == 3) - int(k == 4)); }
#include "rig_window.glsl"

#ifndef RINGS
#define RINGS 4  // of eight neighbours each, 1.4 px away and twice as far from one ring to the next
#endif
#ifndef MAX_DEPTHS
#define MAX_DEPTHS 4  // to choose among
#endif

uniform sampler2D judged;  // from rig_carve.frag

layout(location = 0) out float adopted;

const float max_cost_share = 0.6;  // of the cost so far, that a neighbour's depth has to stay below
const float same_depth = 0.008;    // relative difference of two depths that need not both be tried

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), size = textureSize(judged, 0), last = size - 1;
    vec2 own = texelFetch(judged, at, 0).rg;
    adopted = own.r;
    if (own.g != 0.0) return;
#ifdef WITHOUT_ADOPTION  // tests/bench/step_worth.py
    return;
#endif
    vec2 pixel = vec2(at);
    read_window(pixel, size);
    float own_cost = own.r > 0.0 ? cost_at(pixel, own.r) : unseen_cost;
    // The different depths around, those of the nearest pixels first.
    float depths[MAX_DEPTHS];
    int count = 0;
    for (int k = 0; k < 8 * RINGS && count < MAX_DEPTHS; ++k) {
        int ring = k / 8;
        float angle = 0.785398 * (float(k) + 0.5 * float(ring & 1));
        vec2 there = exp2(float(ring) + 0.5) * vec2(cos(angle), sin(angle));
        vec2 neighbour = texelFetch(judged, clamp(at + ivec2(round(there)), ivec2(0), last), 0).rg;
        float z = neighbour.r;
        bool is_new = neighbour.g > 0.0 && abs(z - own.r) > same_depth * z;
        for (int c = 0; c < count; ++c) is_new = is_new && abs(z - depths[c]) > same_depth * z;
        if (is_new) depths[count++] = z;
    }
    float least = min(matching_cost, max_cost_share * min(own_cost, max_pixel_cost));
    for (int c = 0; c < count; ++c) {
        float cost = cost_at(pixel, depths[c]);
        if (cost < least) least = cost, adopted = depths[c];
    }
    if (adopted == own.r && own_cost > mismatching_cost && own_cost < unseen_cost) adopted = -own.r;
}
