// Differences of colours, 0 to 1.

// The mean absolute difference of red, green and blue.
float colour_difference(vec3 a, vec3 b) { return dot(abs(a - b), vec3(1.0 / 3.0)); }

// Weight of a pixel in an average over one surface, by its colour: 1/e at a difference of `falloff`.
float colour_weight(vec3 a, vec3 b, float falloff) { return exp(-colour_difference(a, b) / falloff); }

// The largest absolute change of red, green or blue.
float largest(vec3 change) {
    change = abs(change);
    return max(change.r, max(change.g, change.b));
}
