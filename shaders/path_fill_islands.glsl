// Islands of like disparity, measured roughly: runs along the rows, added up along the columns.
#include "stereo_common.glsl"

const uint near = 32u;  // 1/32 px, of neighbours of one island

bool are_joined(uint a, uint b) { return a != 0u && b != 0u && max(a, b) - min(a, b) <= near; }
uvec4 are_joined(uvec4 a, uvec4 b) {
    return uvec4(lessThanEqual(max(a, b) - min(a, b), uvec4(near))) * uvec4(notEqual(a, uvec4(0u))) *
           uvec4(notEqual(b, uvec4(0u)));
}
