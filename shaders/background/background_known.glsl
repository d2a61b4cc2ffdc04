// Where a rig's set is known: what has been still for long enough since it changed. Where nothing ever is (a crowd, a
// screen that plays) there is no set, and what the rig shows is taken as it comes.
uniform float known_after;  // instants

const float most_unrest = -4.0, unrest = -3.0;  // of the colour mean's alpha: changes in a row, less what was still

// The first instant counts nothing in the mean's alpha.
bool is_background_known(vec4 state, vec4 colour_mean) { return state.r > 0.0 && colour_mean.a + 1.0 >= known_after; }

bool is_restless(vec4 colour_mean) { return colour_mean.a <= unrest; }
