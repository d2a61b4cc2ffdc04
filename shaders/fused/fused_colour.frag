// The colour of the virtual view on the surface of fused_depth.frag. Every rig whose own depth map has the point
// contributes its colour, weighted by the angle of its line of sight to the virtual camera's, by its resolution there and
// by its distance from depth edges (an unstructured lumigraph: Buehler et al., 2001). Beside a depth edge the two surfaces
// are mixed by the shares that lens and sensor would see, and, since depth is least certain there, by how well the rigs'
// colours match on either. A surface that only rigs from far aside show counts as seen if some rig has seen that the
// space in front of it is empty. The first two rigs are the most useful ones: where one of them sees a place well, the
// other rigs count only if they look from nearly as close.
#ifndef EDGES
#define EDGES 1  // 1: for pixels beside depth edges; 0: for those within a surface
#endif
#ifndef FIRST_RIGS_ONLY
#define FIRST_RIGS_ONLY 0  // 1: discards the pixels where other rigs than the first two count
#endif
#include "fused_around.glsl"
#include "rig_layers.glsl"
#include "sharp_sample.glsl"

uniform float softness;  // relative depth within which two surfaces are one

layout(location = 0) out vec4 fused;
layout(location = 1) out float fused_z;

// Penalties of a surface, relative to each other.
const float cost_penalty = 8.0;   // per squared difference of the rigs' colours (0..1)
const float unchecked_penalty = 0.3;   // only one rig shows the surface
const float fringe_penalty = 3.0;   // only one rig shows it, and that one beside the surface's edge
const float see_through_penalty = 0.5;  // per rig that sees through it
const float hidden_penalty = 0.35;   // it lies behind one that a rig shows right here
const float decisiveness = 4.0;   // how fast a surface's weight falls with its penalty
const float blur_px = 0.75;         // standard deviation of what lens and sensor spread
const float direct_support = 0.01;
const vec2 well_seen = vec2(0.15, 0.5);  // visibility in one of the first two rigs between which the others lose their weight
const vec2 as_close = vec2(0.3, 0.6);    // closeness relative to those two between which the others keep it
const float far_aside = 0.1;          // 1 - cosine of the angle from which on a rig says little about occlusion

const float least_share = 0.05;       // weight relative to the sum so far, from which on a rig's image is resampled sharply
const float fine_share = 0.2;         // the same, from which on a colour is matched to the virtual camera's sharpness

struct Evidence {
    vec3 sum, squares;
    vec4 shares;     // each layer's part of the weight
    float weight;    // of the colours
    float rigs;      // that see the point
    float through;   // rigs that see through it
    float direct;    // the best support by a rig whose depth map has it right there
    float apart;     // from the nearest line of sight that supports it
    float say;       // weight of the next rig, 0..1
    float seen;      // visibility in the rig that sees the point best, 0..1
    float confidence;     // the largest of a rig's colour, 0..1
};

// The share of a rig's four pixels around a point that lie on its surface.
float consistency(sampler2D map, vec2 uv, float z, float tolerance) {
    vec4 surface = abs(textureGather(map, uv));
    float least = min(min(surface.x, surface.y), min(surface.z, surface.w));
    float most = max(max(surface.x, surface.y), max(surface.z, surface.w));
    if (most < least * edge_ratio) {
        float off = max(max(z / most, least / z) - 1.0, 0.0);
        return 1.0 - smoothstep(1.0, 2.0, off / tolerance);
    }
    return dot(1.0 - smoothstep(1.0, 2.0, abs(surface / z - 1.0) / tolerance), vec4(0.25));
}

// Limits the length of a pixel's footprint, since it is computed from inexact depth.
vec2 limited(vec2 pixel) { return pixel * min(1.0, 1.6 / max(length(pixel), 1e-6)); }

float closeness(float away) { return 1.0 / (away + 1e-5); }

void add(int i, sampler2D picture, sampler2D map, vec2 pixel, float z, vec2 slope, bool near_edge,
         bool fine, inout Evidence e) {
    vec4 q = pixel_from_target[i] * vec4(pixel * z, z, 1.0);
    if (q.z <= 0.0) return;
    vec2 uv = (q.xy / q.z + 0.5) / colour_size[i];
    vec2 margin = min(uv, 1.0 - uv);
    float inside = min(margin.x, margin.y);
    if (inside < 0.0) return;
    float tolerance = softness + spread[i] * q.z;
    float sure = consistency(map, uv, q.z, tolerance);
    sure *= sure * sure;
#if LAYERS > 1
    sure = max(sure, own(i));
#endif
    e.direct = max(e.direct, sure);
    if (near_edge && sure < 0.5) {
        vec2 texel = 1.0 / vec2(textureSize(map, 0));
        float around = 0.0, farther = 1.0;
        for (int k = 0; k < 4; ++k) {
            vec4 s = abs(textureGather(map, uv + texel * (vec2(ivec2(k & 1, k >> 1)) * 2.0 - 1.0))) / q.z - 1.0;
            vec4 a = 1.0 - smoothstep(1.0, 2.0, abs(s) / tolerance);
            around = max(around, max(max(a.x, a.y), max(a.z, a.w)));
            farther *= dot(step(vec4(2.0 * tolerance), s), vec4(0.25));
        }
        e.through += step(0.9, farther);
        sure = max(sure, 0.03 * around);
    }
    if (sure <= 0.0) return;
    vec3 point = ray_from_pixel * vec3(pixel, 1.0) * z;
    vec4 middle = textureLod(picture, uv, 0.0);
    // A pixel of the virtual view, along its rows and its columns, in the rig's picture.
    vec2 at = q.xy / q.z;
    vec3 across = (pixel_from_target[i] * vec4(1.0, 0.0, 0.0, slope.x)).xyz * (z / q.z);
    vec3 along = (pixel_from_target[i] * vec4(0.0, 1.0, 0.0, slope.y)).xyz * (z / q.z);
    vec2 right = limited(across.xy - at * across.z), down = limited(along.xy - at * along.z);
    float finer = clamp(abs(right.x * down.y - right.y * down.x), 0.1, 1.0);
    float away = apart(point, centre[i]);
    float seen = presence[i] * sure * middle.a * (smoothstep(0.0, 0.04, inside) + 0.001);
    float weight = e.say * seen * finer * finer * closeness(away);
    e.seen = max(e.seen, seen);
    e.apart = min(e.apart, away);
    e.confidence = max(e.confidence, middle.a);
    // The most useful rigs come first; a rig with a small weight beside them needs no sharp resampling.
    vec3 c = middle.rgb;
    if (weight > least_share * e.weight) {
        float lod = detail_level(pixel_from_target[i], z, q.z);
        c = sharp(picture, uv, lod);
        float share = weight / max(e.weight, 1e-20);
        float finesse = clamp(share / fine_share - 1.0, 0.0, 1.0);
#ifdef WITHOUT_SHARPNESS  // tests/bench/step_worth.py
        fine = false;
#endif
        if (fine && lod <= smooth_from_lod && finesse > 0.0)
            c = clamp(c + finesse * respread(picture, uv, 1.0 / colour_size[i], right, down, middle.rgb), 0.0, 1.0);
    }
    e.sum += weight * c;
    e.squares += weight * c * c;
    e.weight += weight;
    e.shares[i] += weight;
    e.rigs += min(40.0 * sure, 1.0);
}

#if LAYERS > 2
// Returns the weight of the rigs after the first two for a point that those two were sampled for.
float say_of_others(vec2 pixel, float z, Evidence e) {
    vec3 point = ray_from_pixel * vec3(pixel, 1.0) * z;
    float first = 0.5 * (closeness(apart(point, centre[0])) + closeness(apart(point, centre[1])));
    float next = closeness(apart(point, centre[2]));
#if LAYERS > 3
    next = max(next, closeness(apart(point, centre[3])));
#endif
    float are_less_close = 1.0 - smoothstep(as_close.x, as_close.y, next / first);
    return e.apart > far_aside ? 1.0 : 1.0 - smoothstep(well_seen.x, well_seen.y, e.seen) * are_less_close;
}
#endif

Evidence gather(vec2 pixel, float z, vec2 slope, bool near_edge) {
    Evidence e = Evidence(vec3(0.0), vec3(0.0), vec4(0.0), 0.0, 0.0, 0.0, 0.0, 2.0, 1.0, 0.0, 0.0);
    // Inside a surface, where other rigs count, the first two see little.
    const bool are_first_fine = EDGES == 1 || FIRST_RIGS_ONLY == 1 || LAYERS <= 2;
#define ADD(i) add(i, colour[i], source_depth[i], pixel, z, slope, near_edge, i >= 2 || are_first_fine, e);
    ADD(0)
#if LAYERS > 1
    ADD(1)
#endif
#if LAYERS > 2
    e.say = say_of_others(pixel, z, e);
#if !FIRST_RIGS_ONLY
    ADD(2)
#if LAYERS > 3
    ADD(3)
#endif
#endif
#endif
    return e;
}

// Returns the penalty of a surface: how little the evidence supports it.
float penalty(Evidence e) {
#ifdef WITHOUT_COLOUR_PENALTY  // tests/bench/step_worth.py
    if (e.weight > 0.0) return 0.0;
#endif
    if (e.weight == 0.0) return 1e3;
    vec3 mean = e.sum / e.weight;
    vec3 variance = max(e.squares / e.weight - mean * mean, 0.0);
    float lonely = clamp(2.0 - e.rigs, 0.0, 1.0);
    return cost_penalty * dot(variance, vec3(1.0)) + lonely * (e.direct > direct_support ? unchecked_penalty : fringe_penalty) +
           see_through_penalty * e.through;
}

// Whether a rig sees that the point is empty: its surface on that line of sight is farther.
bool sees_empty(int i, sampler2D map, vec2 pixel, float z) {
    vec4 q = pixel_from_target[i] * vec4(pixel * z, z, 1.0);
    vec2 uv = (q.xy / q.z + 0.5) / colour_size[i];
    if (q.z <= 0.0 || any(lessThan(uv, vec2(0.0))) || any(greaterThan(uv, vec2(1.0)))) return false;
    return abs(texelFetch(map, ivec2(uv * vec2(textureSize(map, 0))), 0).r) > q.z;
}

// Whether the rigs have seen that the space in front of a surface is empty, at steps along the virtual camera's ray. A rig
// from far aside may see a surface past an object that hides it from the virtual camera and that no rig shows.
bool is_clear(vec2 pixel, float z) {
    for (float part = 0.5; part < 0.95; part += 0.075) {
        bool empty = false;
#define LOOK_THROUGH(i) empty = empty || sees_empty(i, source_depth[i], pixel, part * z);
        FOR_LAYERS(LOOK_THROUGH)
        if (!empty) return false;
    }
    return true;
}

// The slope of inverse depth from one pixel to the next on one surface.
float slope_of(float before, float z, float after) {
    float a = before > 0.0 && same_surface(before, z) ? 1.0 / z - 1.0 / before : 0.0;
    float b = after > 0.0 && same_surface(after, z) ? 1.0 / after - 1.0 / z : 0.0;
    return a == 0.0 ? b : b == 0.0 ? a : 0.5 * (a + b);
}

void put(vec4 colour, float z, vec4 shares) {
    fused = colour;
    fused_z = z;
    tell_origins(shares);
}

#if EDGES
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 pixel = vec2(at);
    Around near = look_around(at);
    float z = near.here, other = near.other;
    put(vec4(0.0), 0.0, vec4(0.0));
    // The share of each surface that lens and sensor would see here.
    float mine = 0.0, its = 0.0, its_nearness = 0.0;
    for (int k = 0; k < 25; ++k) {
        if (near.z[k] <= 0.0) continue;
        ivec2 off = ivec2(k % 5, k / 5) - 2;
        float w = exp(-float(off.x * off.x + off.y * off.y) / (2.0 * blur_px * blur_px));
        if (same_surface(near.z[k], z)) {
            mine += w;
        } else if (same_surface(near.z[k], other)) {
            its += w;
            its_nearness += w / near.z[k];
        }
    }
    other = its / its_nearness;
    vec2 slope = vec2(slope_of(near.z[11], z, near.z[13]), slope_of(near.z[7], z, near.z[17]));
    Evidence a = gather(pixel, z, slope, true), b = gather(pixel, other, vec2(0.0), true);
    float penalty_a = penalty(a), penalty_b = penalty(b);
    if (z < other)
        penalty_b += hidden_penalty * step(direct_support, a.direct);
    else
        penalty_a += hidden_penalty * step(direct_support, b.direct);
    float min_penalty = min(penalty_a, penalty_b);
    float wa = a.weight > 0.0 ? mine * exp2(-decisiveness * (penalty_a - min_penalty)) : 0.0;
    float wb = b.weight > 0.0 ? its * exp2(-decisiveness * (penalty_b - min_penalty)) : 0.0;
    // In a hole only the farther surface extends, and only if a rig shows it at this very place.
    if (near.own == 0.0) {
        if (z < other || a.direct == 0.0) wa = 0.0;
        if (z > other || b.direct == 0.0) wb = 0.0;
    }
    if (wa + wb == 0.0) return;
    vec3 c = (wa > 0.0 ? wa * a.sum / a.weight : vec3(0.0)) + (wb > 0.0 ? wb * b.sum / b.weight : vec3(0.0));
    bool is_known = near.own > 0.0;
    if (wa > wb ? a.apart > far_aside && !is_clear(pixel, z) : b.apart > far_aside && !is_clear(pixel, other))
        is_known = false;
    put(vec4(c / (wa + wb), alpha_of(is_known, wa > wb ? a.confidence : b.confidence)), wa > wb ? z : other,
         (wa > 0.0 ? wa * a.shares / a.weight : vec4(0.0)) / (wa + wb) +
             (wb > 0.0 ? wb * b.shares / b.weight : vec4(0.0)) / (wa + wb));
}
#else
float z_at(ivec2 at) { return texelFetch(fused_depth, clamp(at, ivec2(0), textureSize(fused_depth, 0) - 1), 0).r; }

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 pixel = vec2(at);
    float own = z_at(at), z = abs(own);
    vec2 slope = vec2(slope_of(z_at(at - ivec2(1, 0)), z, z_at(at + ivec2(1, 0))),
                      slope_of(z_at(at - ivec2(0, 1)), z, z_at(at + ivec2(0, 1))));
    Evidence e = gather(pixel, z, slope, false);
    put(vec4(0.0), 0.0, vec4(0.0));
#if FIRST_RIGS_ONLY
    if (e.say > 0.0) discard;
    bool is_known = own > 0.0;
#else
    if (e.weight == 0.0) return;
    bool is_known = own > 0.0 && (e.apart <= far_aside || is_clear(pixel, z));
#endif
    put(vec4(e.sum / e.weight, alpha_of(is_known, e.confidence)), z, e.shares / e.weight);
}
#endif
