// The depth of a rig's background model, with the learnt depth where the background has changed since.
#include "background_changed.glsl"

uniform sampler2D model;              // metres, 0 = unknown, negative = inpainted
uniform sampler2D background_state;   // from background_learn.frag
uniform sampler2D background_colour;  // the mean of background_colour.frag

layout(location = 0) out float depth_m;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 uv = gl_FragCoord.xy / vec2(textureSize(model, 0));
    float learnt = texelFetch(background_state, at, 0).r;
    depth_m = texelFetch(model, at, 0).r;
    if (learnt > 0.0 && (depth_m <= 0.0 || has_background_changed(learnt, textureLod(background_colour, uv, 0.0).rgb, uv)))
        depth_m = learnt;
}
