// The set of a rig behind its performers, as a background plate.
#include "set_now.glsl"

uniform sampler2D colour;  // from set_colour.frag

layout(location = 0) out vec4 plate_colour;
layout(location = 1) out float plate_m;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float known = set_depth_m(at);
    plate_m = abs(known);
    // What was only guessed nobody has seen.
    float is_seen = texelFetch(set_state, at, 0).r > 0.0 && known > 0.0 ? 1.0 : 0.0;
    plate_colour = vec4(textureLod(colour, gl_FragCoord.xy / vec2(textureSize(model, 0)), 0.0).rgb, is_seen);
}
