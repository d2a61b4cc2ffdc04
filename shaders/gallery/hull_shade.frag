// Lays the visual hull over the background behind it. A point takes its colour from the two rigs whose lines of sight are
// nearest to the virtual camera's, of those that see the point: from whose own place the hull begins there.
#include "hull_rigs.glsl"

uniform sampler2D hull;             // of this view, metres, 0 = none
uniform sampler2D rig_hull[RIGS];   // of the rigs' own, metres, of another size than their pictures
uniform sampler2D colour[RIGS];
uniform vec3 centre[RIGS];          // of the rig, in the virtual camera's coordinates
uniform mat3 ray_from_pixel;        // of the virtual camera
uniform sampler2D background_colour;       // in this view
uniform sampler2D background_behind;       // its depth, metres

layout(location = 0) out vec4 shaded;
layout(location = 1) out float shaded_z;

const float softness = 0.02;  // of depth, within which two hulls are one

// The deepest of the four around, so that a hull's outline hides nothing that is seen beside it.
float hull_of_rig(sampler2D its_hull, vec2 uv) {
    vec4 z = textureGather(its_hull, uv, 0);
    return max(max(z.x, z.y), max(z.z, z.w));
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    shaded = texelFetch(background_colour, at, 0);
    shaded_z = texelFetch(background_behind, at, 0).r;
    float z = texelFetch(hull, at, 0).r;
    if (z == 0.0) return;
    vec2 pixel = vec2(at);
    vec3 point = ray_from_pixel * vec3(pixel, 1.0) * z;
    vec4 best = vec4(0.0), second = vec4(0.0), unseen = vec4(0.0);
    float best_weight = 0.0, second_weight = 0.0, unseen_weight = 0.0;
#define SHADE(i)                                                                                    \
    {                                                                                               \
        vec4 q = pixel_from_target[i] * vec4(pixel * z, z, 1.0);                                    \
        vec2 uv = (q.xy / max(q.z, 1e-6) + 0.5) / picture_size[i];                                  \
        vec2 inside = min(uv, 1.0 - uv);                                                            \
        if (q.z > 0.0 && min(inside.x, inside.y) >= 0.0) {                                          \
            vec4 c = vec4(textureLod(colour[i], uv, 0.0).rgb, 1.0);                                 \
            float weight = 1.0 / (1.0 - dot(normalize(point), normalize(point - centre[i])) + 1e-5);\
            float begins = hull_of_rig(rig_hull[i], uv);                                            \
            if (begins > 0.0 && q.z > begins * (1.0 + softness)) {                                  \
                if (weight > unseen_weight) { unseen = c; unseen_weight = weight; }                 \
            } else if (weight > best_weight) {                                                      \
                second = best; second_weight = best_weight;                                         \
                best = c; best_weight = weight;                                                     \
            } else if (weight > second_weight) {                                                    \
                second = c; second_weight = weight;                                                 \
            }                                                                                       \
        }                                                                                           \
    }
    FOR_RIGS(SHADE)
    vec4 sum = best * best_weight + second * second_weight;
    // What no rig sees takes the nearest one's colour all the same, and is not covered.
    if (sum.a == 0.0) sum = unseen;
    if (sum.a == 0.0) return;
    shaded = vec4(sum.rgb / sum.a, best_weight > 0.0 ? 1.0 : 0.25);
    shaded_z = z;
}
