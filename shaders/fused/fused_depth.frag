// The surface at every pixel of the virtual view: the nearest one that one of the two most useful rigs has measured, or
// another rig where neither has, averaged over the rigs that have it within a soft distance. Depth errors grow with the
// angle to a rig, and those of other rigs would hide what the first two see. A consistency check rejects a surface that
// more rigs see through than have, or as many whose colours differ there (after Penner and Zhang, Soft 3D reconstruction,
// 2017); then the next surface behind it is checked. Inpainted depth counts only where no rig has measured. Near a rig's
// own place the rig's surface prevails over others that are in front of it.
#include "rig_layers.glsl"
#include "two_stages.glsl"

uniform float softness;  // relative depth within which two surfaces are one

layout(location = 0) out float fused_depth;  // metres, 0 = nothing, negative = inpainted

const float alike = 0.06;  // largest range of the rigs' colours (0..1, mean of channels) at one surface

bool is_inpainted(int i, sampler2D map, vec2 pixel, float z) {
    vec4 q = pixel_from_target[i] * vec4(pixel * z, z, 1.0);
    return all(lessThanEqual(textureGather(map, (q.xy / q.z + 0.5) / colour_size[i]), vec4(0.0)));
}

struct Support {
    float rigs;        // rigs that have a surface there
    float through;     // rigs that see through it to a measured surface
    vec3 least, most;  // range of the colours of the rigs from which it is not hidden
};

void examine(int i, sampler2D picture, sampler2D map, vec2 pixel, float z, inout Support support) {
    vec4 q = pixel_from_target[i] * vec4(pixel * z, z, 1.0);
    if (q.z <= 0.0) return;
    vec2 uv = (q.xy / q.z + 0.5) / colour_size[i];
    vec2 inside = min(uv, 1.0 - uv);
    if (min(inside.x, inside.y) < 0.0) return;
    vec4 measured = textureGather(map, uv) / q.z - 1.0, off = abs(measured + 1.0) - 1.0;
    float tolerance = 2.0 * (softness + spread[i] * q.z);
    if (all(lessThan(off, vec4(-tolerance)))) return;
    if (any(lessThan(abs(off), vec4(tolerance))))
        support.rigs += 1.0;
    else if (all(greaterThan(measured, vec4(tolerance))))
        support.through += 1.0;
    vec3 seen = textureLod(picture, uv, 0.0).rgb;
    support.least = min(support.least, seen);
    support.most = max(support.most, seen);
}

bool is_consistent(vec2 pixel, float z) {
#ifdef WITHOUT_CONSISTENCY_CHECK  // tests/bench/step_worth.py
    return true;
#endif
    Support support = Support(0.0, 0.0, vec3(1.0), vec3(0.0));
#define EXAMINE(i) examine(i, colour[i], source_depth[i], pixel, z, support);
    FOR_LAYERS(EXAMINE)
    if (support.through == 0.0 || support.through < support.rigs) return true;
    return support.through == support.rigs && dot(support.most - support.least, vec3(1.0 / 3.0)) < alike;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 pixel = vec2(at);
    float z[LAYERS], candidates[LAYERS];
    float measured = nothing, inpainted = nothing;
#define LOOK(i)                                                 \
    z[i] = layer_z(layer_depth[i], at);                         \
    candidates[i] = nothing;                                    \
    if (z[i] < nothing) {                                       \
        if (is_inpainted(i, source_depth[i], pixel, z[i]))          \
            inpainted = min(inpainted, z[i]);                       \
        else                                                    \
            candidates[i] = z[i];                               \
    }                                                           \
    measured = min(measured, candidates[i]);
    LOOK(0)
#if LAYERS > 1
    LOOK(1)
#endif
#if LAYERS > 2
    float by_the_first = measured;
    LOOK(2)
#if LAYERS > 3
    LOOK(3)
#endif
    if (by_the_first < nothing) measured = by_the_first;
#endif
    bool is_confirmed = measured == nothing;
#if LAYERS > 1
    float most_own = 0.0, own_z = nothing;
#define OWN(i)                                                        \
    {                                                                 \
        float its = z[i] < nothing ? own(i) : 0.0;                    \
        /* Inpainted depth counts only where the rig's image hardly depends on it. */ \
        if (candidates[i] == nothing && its < 0.5) its = 0.0;         \
        if (its > most_own) most_own = its, own_z = z[i];             \
    }
    OWN(0) OWN(1)
    if (most_own > 0.0 && !hides(measured, own_z, most_own)) {
        measured = own_z;
        is_confirmed = most_own > 0.5;
    }
#endif
#if LAYERS == 2
    // Both rigs have it, so that none can see through it.
    is_confirmed = is_confirmed || abs(candidates[0] - candidates[1]) < (softness + spread[0] * measured) * measured;
#endif
    fused_depth = 0.0;
    leave_to_second(!is_confirmed);
#if !FIRST
    is_confirmed = is_confirmed || is_consistent(pixel, measured);
    float next = measured;
    for (int k = 1; k < LAYERS && !is_confirmed; ++k) {
        float before = next * (1.0 + 2.0 * softness);
        next = nothing;
        for (int i = 0; i < LAYERS; ++i)
            if (candidates[i] > before) next = min(next, candidates[i]);
        if (next == nothing) break;
        is_confirmed = is_consistent(pixel, next);
        if (is_confirmed) measured = next;
    }
#endif
    float nearest = measured < nothing ? measured : inpainted;
    if (nearest == nothing) return;
    float sum = 0.0, weights = 0.0;
    vec3 ray = ray_from_pixel * vec3(pixel, 1.0);
#define AVERAGE(i)                                                                                           \
    {                                                                                                        \
        float w = 1.0 - smoothstep(1.0, 2.0, abs(z[i] / nearest - 1.0) / (softness + spread[i] * nearest));  \
        if (w > 0.0) {                                                                                       \
            w *= presence[i] / (apart(ray * z[i], centre[i]) + 1e-5);                                                       \
            sum += w * z[i];                                                                                 \
            weights += w;                                                                                    \
        }                                                                                                    \
    }
    FOR_LAYERS(AVERAGE)
    fused_depth = (measured < nothing ? 1.0 : -1.0) * sum / weights;
}
