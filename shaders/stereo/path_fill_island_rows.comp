// How long the run of like disparities is that a cell of the fill lies in. One invocation a row, four cells a step.
#include "path_fill_near.glsl"
#include "stereo_common.glsl"

layout(local_size_x = LANES) in;
layout(std430, binding = 0) readonly buffer Cells { uvec4 cells[]; };  // disparity in the lower half
layout(std430, binding = 1) buffer Runs { uvec4 runs[]; };
uniform ivec2 size;  // cells
uniform int stride;

uint before, count;
#define FROM_LEFT(here, run)                          \
    count = are_near(before, here) ? count + 1u : 1u; \
    run = count;                                      \
    before = here;
#define FROM_RIGHT(here, run)                     \
    count = are_near(before, here) ? count : run; \
    run = count;                                  \
    before = here;

void main() {
    int y = int(gl_GlobalInvocationID.x);
    if (y >= size.y) return;
    int first = y * stride / 4, last = first + (size.x - 1) / 4;
    before = count = 0u;
    for (int at = first; at <= last; ++at) {
        uvec4 here = cells[at] & 0xffffu, run;
        FROM_LEFT(here.x, run.x) FROM_LEFT(here.y, run.y) FROM_LEFT(here.z, run.z) FROM_LEFT(here.w, run.w)
        runs[at] = run;
    }
    before = 0u;
    for (int at = last; at >= first; --at) {
        uvec4 here = cells[at] & 0xffffu, run = runs[at];
        FROM_RIGHT(here.w, run.w) FROM_RIGHT(here.z, run.z) FROM_RIGHT(here.y, run.y) FROM_RIGHT(here.x, run.x)
        runs[at] = run;
    }
}
