// The depth of a rig's set: its model's, but where the set has changed since that was made.
uniform sampler2D model;      // metres, 0 = unknown, negative = guessed
uniform sampler2D background_state;  // from background_learn.frag
uniform float since;          // instants that were learnt of since the model was made

// Of a pixel with this state.
float background_depth_m(ivec2 at, vec4 state) {
    return state.r > 0.0 && state.g <= since ? state.r : texelFetch(model, at, 0).r;
}
