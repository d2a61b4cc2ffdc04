// The colour of a baked background in the virtual view: that of the rigs that see the surface, which was decided when it
// was baked, weighted by the angle between their lines of sight and the virtual camera's and by their edge confidence.
#ifndef PLAIN
#define PLAIN 0  // 1: colours are no sharper than bilinear
#endif
#ifndef ORIGINS
#define ORIGINS 0  // 1: writes the rigs' shares in each colour
#endif
#ifndef SOURCES
#define SOURCES 4
#endif
#include "sharp_sample.glsl"

uniform sampler2D weights;          // how well the rigs see the surface, in the owner's depth map
uniform sampler2D colour[SOURCES];  // the rigs' pictures; alpha: the confidence of the colour
uniform float lod[SOURCES];         // level of detail at which one of its pixels is about one of the virtual view
uniform mat4 source_from_channel;   // which channels of the weights are those of the pictures
uniform float is_known;             // 0: the surface is inpainted
uniform float remembered_confidence, remembered_alpha;  // as in rig_layers.glsl
#if ORIGINS
uniform mat4 origin_from_picture;
#endif

in vec3 place[SOURCES];
in vec4 closeness;

layout(location = 0) out vec4 shown;
layout(location = 1) out float shown_z;  // metres, 0 = nothing
#if ORIGINS
layout(location = 2) out vec4 origins;
#endif

#if !PLAIN
const float least_share = 0.05;  // of the weight, from which on a picture is sampled sharply
#endif

void main() {
    vec4 w = source_from_channel * textureLod(weights, place[0].xy / place[0].z, 0.0) * closeness;
    vec3 sum = vec3(0.0);
    float confidence = 0.0;
#define ADD(k)                                                         \
    {                                                                  \
        vec2 uv = place[k].xy / place[k].z;                            \
        vec4 c = textureLod(colour[k], uv, lod[k]);                     \
        w[k] *= c.a;                                                   \
        confidence = max(confidence, w[k] > 0.0 ? c.a : 0.0);          \
        SHARPEN(k)                                                     \
        sum += w[k] * c.rgb;                                           \
    }
#if PLAIN
#define SHARPEN(k)
#else
#define SHARPEN(k) if (w[k] > least_share * (w[0] + w[1] + w[2] + w[3])) c.rgb = sharp(colour[k], uv, lod[k]);
#endif
    ADD(0)
    ADD(1)
    ADD(2)
#if SOURCES > 3
    ADD(3)
#endif
    float all = w[0] + w[1] + w[2] + w[3];
    bool is_seen = all > 0.0;
    float alpha = is_known == 0.0 ? 0.25 : confidence > remembered_confidence + 0.5 / 255.0 ? 1.0 : remembered_alpha;
    shown = is_seen ? vec4(sum / all, alpha) : vec4(0.0);
    shown_z = is_seen ? 1.0 / gl_FragCoord.w : 0.0;
#if ORIGINS
    origins = is_seen ? origin_from_picture * (w / all) : vec4(0.0);
#endif
}
