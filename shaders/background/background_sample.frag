// Samples whether a rig's background is known (red) and its matte (green) on a coarse grid.
#include "background_known.glsl"

uniform sampler2D background_state;   // from background_learn.frag
uniform sampler2D background_colour;  // the mean of background_colour.frag
uniform sampler2D matte;       // from matte_edges.frag
uniform vec2 sample_share;     // of the picture, from one sample to the next

layout(location = 0) out vec2 seen;

void main() {
    vec2 share = gl_FragCoord.xy * sample_share;
    bool is_known = is_background_known(textureLod(background_state, share, 0.0), textureLod(background_colour, share, 0.0));
    seen = vec2(is_known ? 1.0 : 0.0, textureLod(matte, share, 0.0).r);
}
