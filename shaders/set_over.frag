// What a rig sees at this instant: its performers before its set. The set's depth is the model's, but where the set has
// changed since that was made.
uniform sampler2D model;       // depth of the set: metres, 0 = unknown, negative = guessed
uniform sampler2D set_state;   // from set_learn.frag
uniform sampler2D performers;  // depth, metres, 0 = none
uniform sampler2D matte;       // the performers' share
uniform float since;           // instants since the model was made

layout(location = 0) out float depth_m;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 state = texelFetch(set_state, at, 0).rg;
    depth_m = state.r > 0.0 && state.g <= since ? state.r : texelFetch(model, at, 0).r;
    float performer_m = texelFetch(performers, at, 0).r;
    if (performer_m != 0.0 && textureLod(matte, gl_FragCoord.xy / vec2(textureSize(model, 0)), 0.0).r >= 0.5)
        depth_m = performer_m;
}
