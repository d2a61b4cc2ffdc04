// The depth of a rig's background: from background stereo where the background is still as it was then, except for its
// light, and as learnt since elsewhere.
#include "colour_difference.glsl"
#include "tolerances.glsl"

uniform sampler2D learnt;       // metres in the first channel, 0 = unknown
uniform sampler2D picture;      // the background's
uniform sampler2D learnt_then;  // when background stereo began, metres; may be of a smaller size
uniform sampler2D picture_then;
uniform sampler2D matched;      // metres, 0 = unknown
uniform float spread;           // relative uncertainty of depth, per metre of it

layout(location = 0) out float depth;  // metres, 0 = unknown

const float darkest = 0.4, brightest = 2.5;  // change of light, at most
const float max_change = 0.12;               // of a colour beside that

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 uv = (vec2(at) + 0.5) / vec2(textureSize(learnt, 0));
    float now = texelFetch(learnt, at, 0).r, then = textureLod(learnt_then, uv, 0.0).r;
    float found = textureLod(matched, uv, 0.0).r;
    vec3 colour = textureLod(picture, uv, 0.0).rgb, before = textureLod(picture_then, uv, 0.0).rgb;
    const vec3 mean = vec3(1.0 / 3.0);
    float light = clamp(dot(colour, mean) / max(dot(before, mean), 0.01), darkest, brightest);
    bool is_same = abs(now - then) <= now * (surface_share + surface_sigmas * spread * now) &&
                   largest(colour - light * before) < max_change;
    depth = found > 0.0 && is_same ? found : now;
}
