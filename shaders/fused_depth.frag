// The surface at every pixel of the virtual view: the nearest one that one of the two most useful rigs has measured, or,
// where neither has, another rig, averaged over the rigs that agree on it within a soft distance. From farther aside
// errors of depth are longer, and would stand before what those two see. A guessed depth counts only where nobody
// measured.
#include "rig_layers.glsl"

uniform float softness;  // relative depth within which two surfaces are one

layout(location = 0) out float fused_depth;  // metres, 0 = nothing, negative = guessed

bool is_guess(int i, sampler2D map, vec2 pixel, float z) {
    vec4 q = pixel_from_target[i] * vec4(pixel * z, z, 1.0);
    return all(lessThanEqual(textureGather(map, (q.xy / q.z + 0.5) / colour_size[i]), vec4(0.0)));
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 pixel = vec2(at);
    float z[LAYERS];
    float measured = nothing, guessed = nothing;
#define LOOK(i)                                                 \
    z[i] = layer_z(layer_depth[i], at);                         \
    if (z[i] < nothing) {                                       \
        if (is_guess(i, source_depth[i], pixel, z[i]))          \
            guessed = min(guessed, z[i]);                       \
        else                                                    \
            measured = min(measured, z[i]);                     \
    }
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
    float nearest = measured < nothing ? measured : guessed;
    fused_depth = 0.0;
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
