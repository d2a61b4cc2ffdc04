// Fills unknown disparities from the background: of the nearest sources to the left and to the right in the row, the
// smaller; in a row without sources everything known is one. What is filled has confidence 0. One invocation a row,
// four pixels a step.
#include "stereo_common.glsl"

layout(local_size_x = LANES) in;
layout(std430, binding = 0) readonly buffer Disparity { uvec4 disparity[]; };
layout(std430, binding = 1) buffer Filled { uvec4 filled[]; };  // the sources before, the result after
uniform ivec2 size;
uniform int stride;

const uint source_mark = 0x80000000u;

uint known;
// The source that lies here or else the nearest one on the side one comes from, marked where it lies here.
#define FROM_RIGHT(here)                      \
    known = here != 0u ? here : known;        \
    here = here != 0u ? here | source_mark : known;
#define FROM_LEFT(right, here)                                                                   \
    known = (right & source_mark) != 0u ? right & 0xffffu : known;                               \
    right &= 0xffffu;                                                                            \
    right = known != 0u && right != 0u ? min(known, right) : max(known, right);                  \
    right = (here & 0xffffu) != 0u ? here : right;

void main() {
    int y = int(gl_GlobalInvocationID.x);
    if (y >= size.y) return;
    int first = y * stride / 4, last = first + (size.x - 1) / 4;
    // Nothing lies behind the picture.
    uvec4 inside = uvec4(greaterThan(ivec4(((size.x - 1) & 3) + 1), ivec4(0, 1, 2, 3))) * 0xffffu;
    known = 0u;
    for (int attempt = 0; attempt < 2 && known == 0u; ++attempt)
        for (int at = last; at >= first; --at) {
            uvec4 here = (attempt == 0 ? filled[at] : disparity[at]) & (at == last ? inside : uvec4(0xffffu));
            FROM_RIGHT(here.w) FROM_RIGHT(here.z) FROM_RIGHT(here.y) FROM_RIGHT(here.x)
            filled[at] = here;
        }
    known = 0u;
    for (int at = first; at <= last; ++at) {
        uvec4 here = disparity[at], right = filled[at];
        FROM_LEFT(right.x, here.x) FROM_LEFT(right.y, here.y) FROM_LEFT(right.z, here.z) FROM_LEFT(right.w, here.w)
        filled[at] = right;
    }
}
