// Where a rig's background is known: the pixel has not changed for long enough. A place where nothing ever stands still
// (a crowd, a video screen) has no background; its pixels are shown as they come.
uniform float known_after;  // instants

// Alpha of the colour mean counts instants without change; below 0 it counts changes in a row, less instants without.
const float min_still = -4.0, restless_still = -3.0;

// The first instant adds nothing to the mean's alpha.
bool is_background_known(vec4 state, vec4 colour_mean) { return state.r > 0.0 && colour_mean.a + 1.0 >= known_after; }

bool is_restless(vec4 colour_mean) { return colour_mean.a <= restless_still; }
