// Samples on a coarse grid whether a rig's background is known (red), its matte (green), and whether the background looks
// different from when its model was made (blue).
#include "background_changed.glsl"
#include "background_known.glsl"

uniform sampler2D background_state;   // from background_learn.frag
uniform sampler2D background_colour;  // the mean of background_colour.frag
uniform sampler2D matte;              // from matte_edges.frag
uniform vec2 sample_share;            // of the picture, from one sample to the next

layout(location = 0) out vec4 seen;

void main() {
    vec2 share = gl_FragCoord.xy * sample_share;
    vec4 state = textureLod(background_state, share, 0.0), mean = textureLod(background_colour, share, 0.0);
    bool is_known = is_background_known(state, mean);
    seen = vec4(is_known ? 1.0 : 0.0, textureLod(matte, share, 0.0).r,
                is_known && has_background_changed(state.r, mean.rgb, share) ? 1.0 : 0.0, 0.0);
}
