// The depth of a rig's background: that of its refined model, except where the background has changed since.
uniform sampler2D model;             // metres, 0 = unknown, negative = inpainted
uniform sampler2D background_state;  // from background_learn.frag
uniform float since;                 // learnt instants since the model was made

float background_depth_m(ivec2 at, vec4 state) {
    return state.r > 0.0 && state.g <= since ? state.r : texelFetch(model, at, 0).r;
}
