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

// Doubts, in units of each other.
const float unlike_doubt = 8.0;   // per squared difference of the rigs' colours (0..1)
const float lonely_doubt = 0.3;   // only one rig shows the surface
const float fringe_doubt = 3.0;   // only one rig shows it, and that one beside the surface's edge
const float through_doubt = 0.5;  // per rig that sees through it
const float stay_doubt = 0.6;     // it is not the one that was drawn here
const float hidden_doubt = 0.6;   // it lies behind one that a rig shows right here
const float decisiveness = 8.0;   // how fast a surface fades with its doubt
const float direct_support = 0.01;

struct Evidence {
    vec3 sum, squares;
    float weight;    // of the colours
    float rigs;      // that see the point
    float through;   // rigs that see through it
    float direct;    // the best support by a rig whose depth map has it right there
};

// The share of a rig's four pixels around a point that lie on its surface.
float agreement(sampler2D map, vec2 uv, float z, float tolerance) {
    vec4 surface = abs(textureGather(map, uv));
    float least = min(min(surface.x, surface.y), min(surface.z, surface.w));
    float most = max(max(surface.x, surface.y), max(surface.z, surface.w));
    if (most < least * edge_ratio) {
        float off = max(max(z / most, least / z) - 1.0, 0.0);
        return 1.0 - smoothstep(1.0, 2.0, off / tolerance);
    }
    return dot(1.0 - smoothstep(1.0, 2.0, abs(surface / z - 1.0) / tolerance), vec4(0.25));
}

void add(int i, sampler2D picture, sampler2D map, vec2 pixel, float z, bool near_edge, inout Evidence e) {
    vec4 q = pixel_from_target[i] * vec4(pixel * z, z, 1.0);
    if (q.z <= 0.0) return;
    vec2 uv = (q.xy / q.z + 0.5) / colour_size[i];
    vec2 margin = min(uv, 1.0 - uv);
    float inside = min(margin.x, margin.y);
    if (inside < 0.0) return;
    float tolerance = softness + spread[i] * q.z;
    float sure = agreement(map, uv, q.z, tolerance);
    sure *= sure * sure;
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
    float weight = sure * (smoothstep(0.0, 0.04, inside) + 0.001) / (apart(point, centre[i]) + 1e-5);
    vec3 c = sharp(picture, uv, detail_level(pixel_from_target[i], z, q.z));
    e.sum += weight * c;
    e.squares += weight * c * c;
    e.weight += weight;
    e.rigs += min(40.0 * sure, 1.0);
}

Evidence gather(vec2 pixel, float z, bool near_edge) {
    Evidence e = Evidence(vec3(0.0), vec3(0.0), 0.0, 0.0, 0.0, 0.0);
#define ADD(i) add(i, colour[i], source_depth[i], pixel, z, near_edge, e);
    FOR_LAYERS(ADD)
    return e;
}

// How little the evidence speaks for a surface.
float doubt(Evidence e) {
    if (e.weight == 0.0) return 1e3;
    vec3 mean = e.sum / e.weight;
    vec3 variance = max(e.squares / e.weight - mean * mean, 0.0);
    float lonely = clamp(2.0 - e.rigs, 0.0, 1.0);
    return unlike_doubt * dot(variance, vec3(1.0)) + lonely * (e.direct > direct_support ? lonely_doubt : fringe_doubt) +
           through_doubt * e.through;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 pixel = vec2(at);
    ivec2 last = textureSize(fused_depth, 0) - 1;
    float own = texelFetch(fused_depth, at, 0).r;
    float least = nothing, most = 0.0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
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
    doubt_n += stay_doubt * step(to_far, to_near);
    doubt_f += stay_doubt * step(to_near, to_far);
    doubt_f += hidden_doubt * step(direct_support, n.direct);
    float wn = n.weight > 0.0 ? exp2(-decisiveness * (doubt_n - min(doubt_n, doubt_f))) : 0.0;
    float wf = f.weight > 0.0 ? exp2(-decisiveness * (doubt_f - min(doubt_n, doubt_f))) : 0.0;
    // Where nothing was drawn, only the surface behind reaches in, and only if a rig shows it right here.
    if (z == 0.0) wn = 0.0;
    if (z == 0.0 && f.direct == 0.0) wf = 0.0;
    if (wn + wf == 0.0) return;
    vec3 c = (wn > 0.0 ? wn * n.sum / n.weight : vec3(0.0)) + (wf > 0.0 ? wf * f.sum / f.weight : vec3(0.0));
    fused = vec4(c / (wn + wf), is_known ? 1.0 : 0.25);
    fused_z = wn > wf ? least : most;
}
