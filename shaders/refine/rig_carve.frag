// A rig's depth as the other rigs leave it: carved away where they see through it, that is, where none of them has a
// surface and one sees a farther one. A rig confirms a surface if it has one at the same place that looks alike: what
// repeats, or shows nothing, both rigs' matchers may take for the same wrong place. With MOVES 0, where the others stand
// no farther apart than this rig's own cameras, what none of them confirms becomes a guess (negative), if the map is
// faulty. With MOVES 1 it first goes along with its half-size map, which was refined, and what is known of it goes to
// rig_adopt.frag. A set that was matched against the others' is not doubted: it is not moved, and there are no guesses.
#ifndef MOVES
#define MOVES 1
#endif
#include "rig_others.glsl"

uniform float softness;       // relative depth within which two surfaces are one
uniform bool doubts;          // the map is one rig's own
uniform sampler2D agreement;  // from rig_agreement.frag; if doubts

#if MOVES
// Depth, and what is known of it: 1 = confirmed, 0 = a matcher's that may err, or carved away, -1 = kept, because no
// other rig looks there, or the map was matched or is no matcher's.
layout(location = 0) out vec2 judged;
#else
layout(location = 0) out float carved;
#endif

// Share of a map that others see through from which on it needs their support. Measured depth has up to a tenth of it,
// that of a stereo matcher, whose guesses behind depth edges are as likely wrong as right, twice to eight times as much;
// those who stand close see through less.
#if MOVES
const float faulty = 0.005;
#else
const float faulty = 0.002;
#endif
const float window_px = 0.75;   // from the middle to the sides of what is compared
const float like_colour = 0.05; // mean difference (0..1) of pictures of one surface, at most
const float max_cost = 0.2;  // beyond which nothing is more unlike: one edge does not decide

#if MOVES
uniform sampler2D half_before;  // metres: the half-size map before it was refined, and after; 0 = unknown
uniform sampler2D half_after;
uniform float edge_ratio;       // two depths whose ratio is larger lie on two surfaces
uniform float least_change;     // of inverse depth, relative: less is not worth losing detail for

const float agreed = 0.7;  // share of a map that is exact where nothing is to be gained

// Moves a depth by what the four half-size pixels around it were moved by, those on its surface.
float moved(ivec2 at, float z, vec4 share) {
    if (share.r > agreed * share.a) return z;
    ivec2 last = textureSize(half_before, 0) - 1;
    ivec2 low = (at + 1) / 2 - 1;
    vec2 part = vec2(at & 1) * -0.5 + 0.75;
    float change = 0.0, inverse = 0.0, weights = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 corner = ivec2(i & 1, i >> 1), there = clamp(low + corner, ivec2(0), last);
        float before = texelFetch(half_before, there, 0).r, after = texelFetch(half_after, there, 0).r;
        if (max(before, z) > min(before, z) * edge_ratio || after <= 0.0) continue;
        vec2 w = mix(1.0 - part, part, vec2(corner));
        change += w.x * w.y * before / after;
        inverse += w.x * w.y / after;
        weights += w.x * w.y;
    }
    if (weights == 0.0 || abs(change / weights - 1.0) < least_change) return z;
    return weights > 0.99 ? 1.0 / inverse : z * weights / change;
}
#endif

// Whether what a rig shows around a place looks like what this one shows around a pixel.
bool is_alike(sampler2D colours, vec2 uv, vec2 texel, vec2 pixel) {
    vec2 own_texel = 1.0 / vec2(textureSize(depth_map, 0));
    float cost = 0.0;
    for (int k = 0; k < 9; ++k) {
        vec2 aside = window_px * (vec2(k % 3, k / 3) - 1.0);
        vec3 own = textureLod(picture, (pixel + 0.5 + aside) * own_texel, 0.0).rgb;
        vec3 off = abs(own - textureLod(colours, uv + aside * texel, 0.0).rgb);
        cost += min(dot(off, vec3(1.0 / 3.0)), max_cost);
    }
    return cost < 9.0 * like_colour;
}

void examine(int i, sampler2D map, sampler2D colours, vec2 pixel, float z, inout float support, inout float through, inout float looks) {
    vec4 q = other_from_pixel[i] * vec4(pixel * z, z, 1.0);
    if (q.z <= 0.0) return;
    vec2 uv = (q.xy / q.z + 0.5) / other_size[i];
    vec2 inside = min(uv, 1.0 - uv);
    if (min(inside.x, inside.y) < 0.0) return;
    looks += 1.0;
    vec4 there = textureGather(map, uv);
    vec4 off = there / q.z - 1.0;
    float tolerance = softness + 2.0 * (other_spread[i] * q.z + spread * z);
    bool is_there = any(lessThan(abs(off), vec4(tolerance)));
    if (is_there && is_alike(colours, uv, 1.0 / other_size[i], pixel)) support += 1.0;
    if (all(greaterThan(off, vec4(tolerance)))) through += 1.0;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float z = texelFetch(depth_map, at, 0).r;
    vec4 share = doubts ? textureLod(agreement, vec2(0.5), 16.0) : vec4(0.0);  // of the whole map
    bool errs = share.g > faulty * share.b;
    float support = 0.0, through = 0.0, looks = 0.0;
    if (z > 0.0) {
#if MOVES && !defined(WITHOUT_MOVING)  // tests/bench/step_worth.py
        if (doubts) z = moved(at, z, share);
#endif
#define EXAMINE(i) examine(i, other_depth[i], other_colour[i], vec2(at), z, support, through, looks);
        FOR_OTHERS(EXAMINE)
#ifndef WITHOUT_CARVING  // tests/bench/step_worth.py
        if (through > support) z = 0.0;
#endif
    }
#if MOVES
    bool is_kept = doubts ? !errs || (z > 0.0 && looks == 0.0) : z > 0.0;
    judged = vec2(z, z > 0.0 && support > 0.0 ? 1.0 : is_kept ? -1.0 : 0.0);
#else
    carved = looks > 0.0 && support == 0.0 && errs ? -z : z;
#endif
}
