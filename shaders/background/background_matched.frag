// The depth of a rig's set as it was matched against the other rigs' sets, where what the rig has learnt is still what it
// was then, but for its light; else what it has learnt since.
#include "colour_change.glsl"

uniform sampler2D learnt;       // metres in the first channel, 0 = unknown
uniform sampler2D picture;      // the set's
uniform sampler2D learnt_then;  // when the sets were matched, likewise, of a size that may be smaller
uniform sampler2D picture_then;
uniform sampler2D matched;      // metres, 0 = unknown
uniform float spread;           // relative uncertainty of depth, per metre of it

layout(location = 0) out float depth;  // metres, 0 = unknown

const float softness = 0.02, deviations = 4.0;  // a mean wavers as it is learnt
const float darkest = 0.4, brightest = 2.5;     // of light, against what it was
const float same_colour = 0.12;                 // largest difference (0..1)

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 uv = (vec2(at) + 0.5) / vec2(textureSize(learnt, 0));
    float now = texelFetch(learnt, at, 0).r, then = textureLod(learnt_then, uv, 0.0).r;
    float found = textureLod(matched, uv, 0.0).r;
    vec3 colour = textureLod(picture, uv, 0.0).rgb, before = textureLod(picture_then, uv, 0.0).rgb;
    const vec3 mean = vec3(1.0 / 3.0);
    float light = clamp(dot(colour, mean) / max(dot(before, mean), 0.01), darkest, brightest);
    bool is_same = abs(now - then) <= now * (softness + deviations * spread * now) &&
                   largest(colour - light * before) < same_colour;
    depth = found > 0.0 && is_same ? found : now;
}
