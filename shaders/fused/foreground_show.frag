// Composites the foreground over the background in the virtual view. Takes the nearest of the rigs' foreground surfaces
// that the silhouettes in the two most useful rigs' images allow. Coverage comes from the mattes, since the depth maps
// continue beyond the mattes' edges.
#ifndef LAYERS
#define LAYERS 2
#endif
#ifndef PLAIN
#define PLAIN 0  // 1: colours are no sharper than bilinear
#endif
#ifndef ALONE
#define ALONE 0  // 1: without the background's picture: colours are premultiplied by alpha, and 0 where nothing stands
#endif
// The foreground's layers: colours are premultiplied by alpha, the share of a pixel; source_depth is negative outside the
// matte.
#include "rig_layers.glsl"
#include "tolerances.glsl"
#include "two_stages.glsl"
#if !PLAIN
#include "sharp_sample.glsl"
#endif

#if !ALONE
uniform sampler2D picture;           // the background's
#endif
uniform sampler2D background_depth;  // of the view, metres, 0 = nothing, negative = inpainted
#if ORIGINS && !ALONE
uniform sampler2D background_shares;
#endif
uniform float softness;       // relative depth within which two surfaces are one

layout(location = 0) out vec4 shown;
layout(location = 1) out float shown_z;

const float same_body_share = 0.1;  // relative depth: the silhouettes of surfaces farther away from a point are ignored
const float silhouette_error_px = 1.5;  // by which silhouettes are widened for other rigs, since depth errs
const float min_visibility = 1e-3;  // of a rig that does not see the point: used where no rig does
const float opaque_share = 0.9;     // from which on surfaces behind are not examined
const float seen_share = 0.5;       // of a rig's pixel, from which on the rig sees its foreground there

struct Seen {
    vec3 sum;             // of colours times alpha
    float weight;         // of that
    vec4 shares;          // each layer's part of the weight
    float covers, words;  // the rigs' shares of the pixel, by how close they look; their weight
    float most;           // largest share that the silhouettes allow
    float best;           // visibility in the rig that sees the point best, 0..1
    float first;          // how much of it the first two see, 0..1
};

void look(int i, sampler2D pictures, sampler2D map, vec2 pixel, float z, inout Seen seen) {
    vec4 q = pixel_from_target[i] * vec4(pixel * z, z, 1.0);
    if (q.z <= 0.0) return;
    vec2 uv = (q.xy / q.z + 0.5) / colour_size[i];
    vec2 margin = min(uv, 1.0 - uv);
    float inside = min(margin.x, margin.y);
    if (inside < 0.0) return;
    vec4 off = abs(abs(textureGather(map, uv)) / q.z - 1.0);
    float nearest = min(min(off.x, off.y), min(off.z, off.w));
    if (nearest > same_body_share) return;
    vec4 c = textureLod(pictures, uv, 0.0);
    if (c.a < 1.0 && i < 2) {
        vec2 step = silhouette_error_px / colour_size[i];
        float around = c.a;
        for (int k = 0; k < 4; ++k)
            around = max(around, textureLod(pictures, uv + step * (2.0 * vec2(k & 1, k >> 1) - 1.0), 0.0).a);
        seen.most = min(seen.most, around);
    }
    float sure = 1.0 - smoothstep(1.0, 2.0, nearest / (softness + spread[i] * q.z));
    float away = apart(ray_from_pixel * vec3(pixel, 1.0) * z, centre[i]);
    float sees = presence[i] * smoothstep(0.0, 0.04, inside);
    // The other rigs count where neither of the first two sees the point.
    float say = i < 2 ? 1.0 : 1.0 - smoothstep(0.2, 0.6, seen.best);
    seen.best = max(seen.best, sees * sure);
    if (i < 2) seen.first = max(seen.first, c.a * sees * sure);
#if !PLAIN
    if (c.a > 0.99) c.rgb = sharp(pictures, uv, 0.0);
#endif
    float word = say * (sees + 0.001 * presence[i]) / (away + 1e-5), w = c.a * word * (sure + min_visibility);
    seen.covers += word * c.a;
    seen.words += word;
    seen.sum += w * c.rgb;
    seen.weight += w * c.a;
    seen.shares[i] += w * c.a;
}

// Whether a rig sees its foreground past a point of the background, which then cannot be there.
bool sees_past(int i, sampler2D pictures, sampler2D map, vec2 pixel, float z) {
    vec4 q = pixel_from_target[i] * vec4(pixel * z, z, 1.0);
    vec2 uv = (q.xy / q.z + 0.5) / colour_size[i];
    vec2 margin = min(uv, 1.0 - uv);
    if (q.z <= 0.0 || min(margin.x, margin.y) < 0.0 || textureLod(pictures, uv, 0.0).a < seen_share) return false;
    return (1.0 - view_edge_share) * abs(textureLod(map, uv, 0.0).r) > q.z;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 pixel = vec2(at);
    float set_z = abs(texelFetch(background_depth, at, 0).r);
#if ALONE
    shown = vec4(0.0);
    shown_z = 0.0;
    tell_origins(vec4(0.0));
#else
    shown = texelFetch(picture, at, 0);
    shown_z = set_z;
#if ORIGINS
    tell_origins(texelFetch(background_shares, at, 0));
#endif
#endif
    float z[LAYERS];
#define LOOK(i) z[i] = matted_layer_z(layer_depth[i], at);
    FOR_LAYERS(LOOK)
#if FIRST
    bool has_performer = false;
#define FIND(i) has_performer = has_performer || z[i] < nothing;
    FOR_LAYERS(FIND)
    leave_to_second(has_performer);
#else
    Seen best;
    float share = 0.0, best_z = 0.0;
    vec3 ray = ray_from_pixel * vec3(pixel, 1.0);
    // Depth errors grow with the angle to a rig: the other rigs count only where the first two show neither foreground
    // nor, at this instant, the background.
    float nearest = min(z[0], z[min(1, LAYERS - 1)]);
    bool are_first = true;
    for (int tries = 0; tries < LAYERS; ++tries) {
        if (ALONE == 0 && nearest == nothing && are_first && share == 0.0 && shown.a < 1.0) {
            are_first = false;
#define NEAREST(i) nearest = min(nearest, z[i]);
            FOR_LAYERS(NEAREST)
        }
        if (nearest == nothing) break;
        // The mean of the rigs that have this surface, and the next surface behind it.
        float next = nothing, sum = 0.0, weights = 0.0;
#define AVERAGE(i)                                                                                             \
    if (z[i] < nothing) {                                                                                      \
        float off = abs(z[i] / nearest - 1.0) / (softness + spread[i] * nearest);                              \
        float w = (1.0 - smoothstep(1.0, 2.0, off)) * presence[i] / (apart(ray * z[i], centre[i]) + 1e-5);     \
        sum += w * z[i];                                                                                       \
        weights += w;                                                                                          \
        if (z[i] > nearest * depth_edge_ratio) next = min(next, z[i]);                                         \
    }
        FOR_LAYERS(AVERAGE)
        float there = weights > 0.0 ? sum / weights : nearest;
        if (set_z > 0.0 && set_z < (1.0 - view_edge_share) * there) {
            bool is_refuted = false;
#define SEE_PAST(i) is_refuted = is_refuted || sees_past(i, colour[i], source_depth[i], pixel, set_z);
            FOR_LAYERS(SEE_PAST)
            if (!is_refuted) break;
        }
        Seen seen = Seen(vec3(0.0), 0.0, vec4(0.0), 0.0, 0.0, 1.0, 0.0, 0.0);
#define SEE(i) look(i, colour[i], source_depth[i], pixel, there, seen);
        FOR_LAYERS(SEE)
        if (seen.weight > 0.0 && (!are_first || seen.first > 0.0)) {
            float its = min(seen.covers / seen.words, seen.most);
            if (its > share) best = seen, share = its, best_z = there;
        }
        if (share > opaque_share) break;
        nearest = next;
    }
    if (share == 0.0) return;
    vec3 c = best.sum / best.weight;
    bool is_most = share > 0.5;
#if ALONE
    shown = vec4(share * c, share);
#else
    shown = vec4(mix(shown.rgb, c, share), is_most ? 1.0 : shown.a);
#endif
    if (!is_most) return;
    shown_z = best_z;
    tell_origins(best.shares / best.weight);
#endif
}
