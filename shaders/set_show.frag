// The set of a rig behind its performers, as a background plate.
#include "set_known.glsl"
#include "set_now.glsl"

uniform sampler2D colour;       // from set_colour.frag
uniform sampler2D colour_mean;  // likewise

layout(location = 0) out vec4 plate_colour;
layout(location = 1) out float plate_m;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float known = set_depth_m(at);
    plate_m = abs(known);
    vec2 uv = gl_FragCoord.xy / vec2(textureSize(model, 0));
    // What was only guessed nobody has seen.
    bool is_seen = known > 0.0 && is_set_known(texelFetch(set_state, at, 0), textureLod(colour_mean, uv, 0.0));
    plate_colour = vec4(textureLod(colour, uv, 0.0).rgb, is_seen ? 1.0 : 0.0);
}
