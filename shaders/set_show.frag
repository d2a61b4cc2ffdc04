// The set of a rig behind its performers, as a background plate: the depth of the model, but where the set has changed
// since that was made.
uniform sampler2D model;      // metres, 0 = unknown, negative = guessed
uniform sampler2D set_state;  // from set_learn.frag
uniform sampler2D colour;     // from set_colour.frag
uniform float since;          // instants since the model was made

layout(location = 0) out vec4 plate_colour;
layout(location = 1) out float plate_m;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 state = texelFetch(set_state, at, 0).rg;
    float known = state.r > 0.0 && state.g <= since ? state.r : texelFetch(model, at, 0).r;
    plate_m = abs(known);
    // What was only guessed nobody has seen.
    float is_seen = state.r > 0.0 && known > 0.0 ? 1.0 : 0.0;
    plate_colour = vec4(textureLod(colour, gl_FragCoord.xy / vec2(textureSize(model, 0)), 0.0).rgb, is_seen);
}
