// Disparities of the fill that lie on one surface: both known, and within a pixel of each other.
const uint near = 32u;  // 1/32 px

bool are_near(uint a, uint b) { return a != 0u && b != 0u && max(a, b) - min(a, b) <= near; }
uvec4 are_near(uvec4 a, uvec4 b) {
    return uvec4(lessThanEqual(max(a, b) - min(a, b), uvec4(near))) * uvec4(notEqual(a, uvec4(0u))) *
           uvec4(notEqual(b, uvec4(0u)));
}
