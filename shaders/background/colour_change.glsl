// The largest change of red, green or blue.
float largest(vec3 change) {
    change = abs(change);
    return max(change.r, max(change.g, change.b));
}
