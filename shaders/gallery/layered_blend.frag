// Composes the layers of the nearest rigs (Zitnick et al., 2004): even layers are the rigs' main layers, odd ones their
// matted boundary layers. What the rigs have in front is blended and laid over what they have behind.
#include "rig_layers.glsl"

uniform float softness;  // relative depth within which two surfaces are one

const float shown = 0.3;          // share of a pixel from which on it shows the main layer's surface
const float inpainted_alpha = 0.25;

layout(location = 0) out vec4 blended;
layout(location = 1) out float blended_z;

// Colour and matte of layer i at a point, and how much the rig counts there.
vec4 look(int i, sampler2D picture, float z, vec2 pixel, vec3 ray, out float weight) {
    vec4 q = pixel_from_target[i] * vec4(pixel * z, z, 1.0);
    vec2 uv = (q.xy / q.z + 0.5) / colour_size[i];
    vec2 margin = min(uv, 1.0 - uv);
    weight = (smoothstep(0.0, 0.04, min(margin.x, margin.y)) + 0.001) / (apart(ray * z, centre[i]) + 1e-5);
    return textureLod(picture, uv, detail_level(pixel_from_target[i], z, q.z));
}

bool is_one(int i, float z, float nearest) {
    return z < nothing && z / nearest - 1.0 < 1.5 * (softness + spread[i] * nearest);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 pixel = vec2(at);
    vec3 ray = ray_from_pixel * vec3(pixel, 1.0);
    float z[LAYERS], weight[LAYERS];
    vec4 c[LAYERS];
    float back = nothing, inpainted_back = nothing, front = nothing;
#define LOOK(i)                                                          \
    z[i] = layer_z(layer_depth[i], at);                                  \
    c[i] = look(i, colour[i], min(z[i], 1e6), pixel, ray, weight[i]);    \
    if (i % 2 == 1)                                                      \
        front = min(front, z[i]);                                        \
    else if (c[i].a >= shown)                                            \
        back = min(back, z[i]);                                          \
    else                                                                 \
        inpainted_back = min(inpainted_back, z[i]);
    FOR_LAYERS(LOOK)
    // What a main layer only guesses behind its own strip counts where nobody sees it.
    bool is_seen = back < nothing;
    if (!is_seen) back = inpainted_back;
    vec4 behind = vec4(0.0), before = vec4(0.0), shares = vec4(0.0);
    float matte = 0.0;
#define ADD(i)                                                       \
    if (is_one(i, z[i], i % 2 == 0 ? back : front)) {                \
        if (i % 2 == 0) {                                            \
            weight[i] *= c[i].a;                                     \
            behind += weight[i] * vec4(c[i].rgb, 1.0);               \
        } else {                                                     \
            before += weight[i] * vec4(c[i].rgb, 1.0);               \
            matte += weight[i] * c[i].a;                             \
        }                                                            \
        shares[i] += weight[i];                                      \
    }
    FOR_LAYERS(ADD)
    float share = before.a > 0.0 ? matte / before.a : 0.0;
    // A strip that lies behind the main layer is hidden by it.
    if (front > back * (1.0 + softness)) share = 0.0;
    blended = vec4(0.0);
    blended_z = 0.0;
    tell_origins(vec4(0.0));
    if (behind.a == 0.0 && share < 0.5) return;
    // Odd layers are in front.
    vec4 of_front = shares * vec4(0.0, 1.0, 0.0, 1.0) / max(before.a, 1e-12);
    vec4 of_back = shares * vec4(1.0, 0.0, 1.0, 0.0) / max(behind.a, 1e-12);
    tell_origins(mix(of_back, of_front, behind.a == 0.0 ? 1.0 : share));
    if (behind.a == 0.0) {
        blended = vec4(before.rgb / before.a, 1.0);
        blended_z = front;
        return;
    }
    vec3 b = behind.rgb / behind.a;
    blended = vec4(share > 0.0 ? mix(b, before.rgb / before.a, share) : b, is_seen || share >= 0.5 ? 1.0 : inpainted_alpha);
    blended_z = share > 0.5 ? front : back;
}
