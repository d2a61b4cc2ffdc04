// Fills unknown disparities from the background: of the nearest sources to the left and to the right in the row, the
// smaller; in a row without sources everything known is one. What is filled has confidence 0. One invocation a row.
#include "stereo_common.glsl"

layout(local_size_x = LANES) in;
layout(std430, binding = 0) readonly buffer Disparity { uint disparity[]; };
layout(std430, binding = 1) buffer Filled { uint filled[]; };  // the sources before, the result after
uniform ivec2 size;
uniform int stride;

const uint source_mark = 0x80000000u;

void main() {
    int y = int(gl_GlobalInvocationID.x);
    if (y >= size.y) return;
    int row = y * stride;
    uint known = 0u;
    for (int attempt = 0; attempt < 2 && known == 0u; ++attempt)
        for (int x = size.x - 1; x >= 0; --x) {
            uint here = (attempt == 0 ? filled[row + x] : disparity[row + x]) & 0xffffu;
            if (here != 0u) known = here;
            filled[row + x] = here != 0u ? here | source_mark : known;
        }
    known = 0u;
    for (int x = 0; x < size.x; ++x) {
        uint here = disparity[row + x], right = filled[row + x] & 0xffffu;
        if ((filled[row + x] & source_mark) != 0u) known = right;
        uint background = known != 0u && right != 0u ? min(known, right) : max(known, right);
        filled[row + x] = (here & 0xffffu) != 0u ? here : background;
    }
}
