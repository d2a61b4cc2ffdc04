// The colour of the virtual view on the surface that fused_depth.frag found. Every rig whose own depth map says that it
// sees a point gives its colour, weighted by how close its line of sight is to the virtual camera's, its resolution
// there and its distance from depth edges (an unstructured lumigraph: Buehler et al., 2001). Close to a depth edge,
// where depth is least to be trusted, the nearer and the farther surface of the neighbourhood compete: the rigs' colours
// agree on the right one. The loser fades, so that edges are soft.
#include "rig_layers.glsl"
#include "sharp_sample.glsl"

uniform sampler2D fused_depth;  // metres, 0 = nothing, negative = guessed
uniform float softness;         // relative depth within which two surfaces are one
uniform float edge_ratio;       // two depths whose ratio is larger lie on two surfaces

layout(location = 0) out vec4 fused;
layout(location = 1) out float fused_z;

#ifndef NEIGHBOURHOOD
#define NEIGHBOURHOOD 2
#endif
#ifndef VAR_COST
#define VAR_COST 60.0
#endif
#ifndef SINGLE_COST
#define SINGLE_COST 0.6
#endif
#ifndef THROUGH_COST
#define THROUGH_COST 0.5
#endif
#ifndef STAY
#define STAY 0.3
#endif

struct Evidence {
    vec3 sum, squares;
    float weight;    // of the colours
    float rigs;      // that see the point
    float through;   // rigs that see through it
};

void add(int i, sampler2D picture, sampler2D map, vec2 pixel, float z, bool near_edge, inout Evidence e) {
    vec4 q = pixel_from_target[i] * vec4(pixel * z, z, 1.0);
    if (q.z <= 0.0) return;
    vec2 uv = (q.xy / q.z + 0.5) / colour_size[i];
    vec2 margin = min(uv, 1.0 - uv);
    float inside = min(margin.x, margin.y);
    if (inside < 0.0) return;
    float tolerance = softness + spread[i] * q.z;
    vec4 surface = abs(textureGather(map, uv)) / q.z - 1.0;
    vec4 agree = 1.0 - smoothstep(1.0, 2.0, abs(surface) / tolerance);
    float sure = dot(agree, vec4(0.25));
    sure *= sure;
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
        sure = max(sure, 0.25 * around);
    }
    if (sure <= 0.0) return;
    vec3 point = ray_from_pixel * vec3(pixel, 1.0) * z;
    float weight = sure * (smoothstep(0.0, 0.04, inside) + 0.001) / (apart(point, centre[i]) + 1e-5);
    vec3 c = sharp(picture, uv, detail_level(pixel_from_target[i], z, q.z));
    e.sum += weight * c;
    e.squares += weight * c * c;
    e.weight += weight;
    e.rigs += min(4.0 * sure, 1.0);
}

Evidence gather(vec2 pixel, float z, bool near_edge) {
    Evidence e = Evidence(vec3(0.0), vec3(0.0), 0.0, 0.0, 0.0);
#define ADD(i) add(i, colour[i], source_depth[i], pixel, z, near_edge, e);
    FOR_LAYERS(ADD)
    return e;
}

// How little the evidence speaks for a surface.
float doubt(Evidence e) {
    if (e.weight == 0.0) return 1e3;
    vec3 mean = e.sum / e.weight;
    vec3 variance = max(e.squares / e.weight - mean * mean, 0.0);
    return VAR_COST * dot(variance, vec3(1.0)) + SINGLE_COST * max(2.0 - e.rigs, 0.0) + THROUGH_COST * e.through;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 pixel = vec2(at);
    ivec2 last = textureSize(fused_depth, 0) - 1;
    float own = texelFetch(fused_depth, at, 0).r;
    float least = nothing, most = 0.0;
    for (int y = -NEIGHBOURHOOD; y <= NEIGHBOURHOOD; ++y)
        for (int x = -NEIGHBOURHOOD; x <= NEIGHBOURHOOD; ++x) {
            float z = texelFetch(fused_depth, clamp(at + ivec2(x, y), ivec2(0), last), 0).r;
            if (z > 0.0) {
                least = min(least, z);
                most = max(most, z);
            }
        }
    bool is_known = own > 0.0;
    float z = abs(own);
    bool near_edge = most > least * edge_ratio;
    fused = vec4(0.0);
    fused_z = 0.0;
    if (z == 0.0 && most == 0.0) return;
    if (z > 0.0 && !near_edge) {
        Evidence e = gather(pixel, z, false);
        if (e.weight > 0.0) {
            fused = vec4(e.sum / e.weight, is_known ? 1.0 : 0.25);
            fused_z = z;
            return;
        }
        near_edge = true;
        if (most == 0.0) return;
    }
    Evidence n = gather(pixel, least, true), f = gather(pixel, most, true);
    float doubt_n = doubt(n), doubt_f = doubt(f);
    float to_near = z > 0.0 ? abs(z / least - 1.0) : 0.5, to_far = z > 0.0 ? abs(most / z - 1.0) : 0.5;
    doubt_n += STAY * step(to_far, to_near);
    doubt_f += STAY * step(to_near, to_far);
    float wn = n.weight > 0.0 ? exp2(-8.0 * (doubt_n - min(doubt_n, doubt_f))) : 0.0;
    float wf = f.weight > 0.0 ? exp2(-8.0 * (doubt_f - min(doubt_n, doubt_f))) : 0.0;
    if (wn + wf == 0.0) return;
    vec3 c = (wn > 0.0 ? wn * n.sum / n.weight : vec3(0.0)) + (wf > 0.0 ? wf * f.sum / f.weight : vec3(0.0));
    fused = vec4(c / (wn + wf), is_known ? 1.0 : 0.25);
    fused_z = wn > wf ? least : most;
}
