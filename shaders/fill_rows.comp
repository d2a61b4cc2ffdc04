// Fills unknown disparities from the background: of the nearest known ones to the left and to the right in the
// row, the smaller. What is filled has confidence 0. One invocation a row.
#include "stereo_common.glsl"

layout(local_size_x = LANES) in;
layout(std430, binding = 0) readonly buffer Disparity { uint disparity[]; };
layout(std430, binding = 1) buffer Filled { uint filled[]; };
uniform ivec2 size;
uniform int stride;

void main() {
    int y = int(gl_GlobalInvocationID.x);
    if (y >= size.y) return;
    int row = y * stride;
    uint known = 0u;
    for (int x = size.x - 1; x >= 0; --x) {
        uint here = disparity[row + x];
        known = (here & 0xffffu) != 0u ? here : known & 0xffffu;
        filled[row + x] = known;
    }
    known = 0u;
    for (int x = 0; x < size.x; ++x) {
        uint here = disparity[row + x];
        if ((here & 0xffffu) != 0u) {
            known = here & 0xffffu;
        } else if (known != 0u) {
            uint right = filled[row + x] & 0xffffu;
            filled[row + x] = right != 0u ? min(known, right) : known;
        }
    }
}
