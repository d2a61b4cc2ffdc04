// A rig's depth after the consistency check with the other rigs. A pixel is carved away (0) where other rigs see through
// it: none of them has a surface there, and one sees a farther one. A rig confirms a surface if it has one at the same
// place and its picture looks the same there, since repetitive structure and plain walls deceive both rigs' matchers
// alike. With MOVES 0, if the others stand no farther apart than this rig's own cameras, a depth that none of them confirms
// is marked as inpainted (negative) if the map errs. With MOVES 1 depth first follows its half-size map, which was refined,
// and the result of the check goes to rig_adopt.frag. The depth of background stereo needs no check of this kind: it is
// neither moved nor marked.
#ifndef MOVES
#define MOVES 1
#endif
#include "rig_others.glsl"

uniform bool is_single_rig;     // the map is one rig's own stereo depth, not that of background stereo
uniform sampler2D consistency;  // from rig_consistency.frag; read if is_single_rig

#if MOVES
// Depth, and the result of the check: 1 = confirmed; 0 = carved away, or unconfirmed in a map that errs; -1 = kept, since no
// other rig sees the place, or the map does not err or is not one rig's own.
layout(location = 0) out vec2 judged;
#else
layout(location = 0) out float carved;
#endif

// Share of a map that others see through, from which on the map errs and its depth needs confirmation. Exact depth has up
// to a tenth of it; a stereo matcher, which extrapolates behind depth edges, two to eight times as much. Rigs that stand
// close to each other see through less.
#if MOVES
const float faulty_share = 0.005;
#else
const float faulty_share = 0.002;
#endif
const float window_px = 0.75;        // from the middle to the sides of the window that is compared
const float max_confirm_cost = 0.2;  // of one of its pixels, so that one edge does not decide

#if MOVES
uniform sampler2D half_before;  // metres: the half-size map before it was refined, and after; 0 = unknown
uniform sampler2D half_after;
uniform float min_change;       // of inverse depth, relative: smaller moves would only lose detail

const float exact_share = 0.7;  // share of a map that is exact, from which on nothing is moved

// Moves a depth by the mean move of those of the four half-size pixels around it that lie on its surface.
float moved(ivec2 at, float z, vec4 share) {
    if (share.r > exact_share * share.a) return z;
    ivec2 last = textureSize(half_before, 0) - 1;
    ivec2 low = (at + 1) / 2 - 1;
    vec2 part = vec2(at & 1) * -0.5 + 0.75;
    float change = 0.0, inverse = 0.0, weights = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 corner = ivec2(i & 1, i >> 1), there = clamp(low + corner, ivec2(0), last);
        float before = texelFetch(half_before, there, 0).r, after = texelFetch(half_after, there, 0).r;
        if (max(before, z) > min(before, z) * depth_edge_ratio || after <= 0.0) continue;
        vec2 w = mix(1.0 - part, part, vec2(corner));
        change += w.x * w.y * before / after;
        inverse += w.x * w.y / after;
        weights += w.x * w.y;
    }
    if (weights == 0.0 || abs(change / weights - 1.0) < min_change) return z;
    return weights > 0.99 ? 1.0 / inverse : z * weights / change;
}
#endif

// Whether another rig's picture around a place matches this rig's picture around a pixel.
bool is_similar(sampler2D colours, vec2 uv, vec2 texel, vec2 pixel) {
    vec2 own_texel = 1.0 / vec2(textureSize(depth_map, 0));
    float cost = 0.0;
    for (int k = 0; k < 9; ++k) {
        vec2 aside = window_px * (vec2(k % 3, k / 3) - 1.0);
        vec3 own = textureLod(picture, (pixel + 0.5 + aside) * own_texel, 0.0).rgb;
        cost += min(colour_difference(own, textureLod(colours, uv + aside * texel, 0.0).rgb), max_confirm_cost);
    }
    return cost < 9.0 * confirming_cost;
}

// Counts the rigs that have the place in their picture, that confirm the depth, and that see through it.
void check(int i, sampler2D map, sampler2D colours, vec2 pixel, float z, inout float seen, inout float confirmed, inout float through) {
    vec2 uv;
    float other_z;
    if (!project(i, pixel, z, uv, other_z)) return;
    seen += 1.0;
    vec4 off = textureGather(map, uv) / other_z - 1.0;
    float tolerance = surface_tolerance(i, other_z, z, consistent_sigmas);
    bool is_there = any(lessThan(abs(off), vec4(tolerance)));
    if (is_there && is_similar(colours, uv, 1.0 / other_size[i], pixel)) confirmed += 1.0;
    if (all(greaterThan(off, vec4(tolerance)))) through += 1.0;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float z = texelFetch(depth_map, at, 0).r;
    vec4 share = is_single_rig ? textureLod(consistency, vec2(0.5), 16.0) : vec4(0.0);  // means over the map
    bool errs = share.g > faulty_share * share.b;
    float seen = 0.0, confirmed = 0.0, through = 0.0;
    if (z > 0.0) {
#if MOVES && !defined(WITHOUT_MOVING)  // tests/bench/step_worth.py
        if (is_single_rig) z = moved(at, z, share);
#endif
#define CHECK(i) check(i, other_depth[i], other_colour[i], vec2(at), z, seen, confirmed, through);
        FOR_OTHERS(CHECK)
#ifndef WITHOUT_CARVING  // tests/bench/step_worth.py
        if (through > confirmed) z = 0.0;
#endif
    }
#if MOVES
    bool is_kept = is_single_rig ? !errs || (z > 0.0 && seen == 0.0) : z > 0.0;
    judged = vec2(z, z > 0.0 && confirmed > 0.0 ? 1.0 : is_kept ? -1.0 : 0.0);
#else
    carved = seen > 0.0 && confirmed == 0.0 && errs ? -z : z;
#endif
}
