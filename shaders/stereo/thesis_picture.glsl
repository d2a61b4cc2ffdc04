// Pictures of the thesis' matcher: a word a pixel in a storage buffer, R in the lowest byte.
ivec3 colour_of(uint word) {
    return ivec3(word & 255u, (word >> 8) & 255u, (word >> 16) & 255u);
}

int colour_distance(ivec3 a, ivec3 b) {
    ivec3 difference = abs(a - b);
    return difference.x + difference.y + difference.z;
}
