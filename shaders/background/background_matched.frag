// The depth of a rig's background: from background stereo where depth and colour are still as they were when it began,
// and as learnt since elsewhere.
#include "background_changed.glsl"

uniform sampler2D learnt;   // metres in the first channel, 0 = unknown
uniform sampler2D picture;  // the background's
uniform sampler2D matched;  // metres, 0 = unknown

layout(location = 0) out float depth;  // metres, 0 = unknown

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 uv = (vec2(at) + 0.5) / vec2(textureSize(learnt, 0));
    float now = texelFetch(learnt, at, 0).r, found = textureLod(matched, uv, 0.0).r;
    bool is_same = is_depth_as_then(now, uv) && is_colour_as_then(textureLod(picture, uv, 0.0).rgb, uv);
    depth = found > 0.0 && is_same ? found : now;
}
