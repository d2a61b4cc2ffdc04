// Adds the runs of path_fill_island_rows.comp up along the columns and leaves what the fill may spread: the disparities of
// islands that are large enough. One invocation walks four columns.
#include "path_fill.glsl"
#include "path_fill_near.glsl"
#include "stereo_common.glsl"

#ifndef LEAST_AREA
#define LEAST_AREA 32u  // cells
#endif

layout(local_size_x = LANES) in;
layout(std430, binding = 0) readonly buffer Cells { uvec4 cells[]; };  // disparity in the lower half
layout(std430, binding = 1) buffer Paths { uvec4 paths[]; };           // runs before, path_fill.glsl's form after
uniform ivec2 size;  // cells
uniform int stride;

void main() {
    int column = int(gl_GlobalInvocationID.x);
    if (column * 4 >= size.x) return;
    int step = stride >> 2, last = column + (size.y - 1) * step;
    uvec4 before = uvec4(0u), sum = uvec4(0u);
    for (int at = column; at <= last; at += step) {
        uvec4 here = cells[at] & 0xffffu;
        sum = sum * are_near(before, here) + paths[at];
        paths[at] = sum;
        before = here;
    }
    uvec4 inside = uvec4(lessThan(ivec4(column * 4) + ivec4(0, 1, 2, 3), ivec4(size.x)));
    before = uvec4(0u);
    for (int at = last; at >= column; at -= step) {
        uvec4 here = cells[at] & 0xffffu, above = paths[at];
        uvec4 joined = are_near(before, here);
        sum = sum * joined + above * (1u - joined);
        uvec4 holds = uvec4(greaterThanEqual(sum, uvec4(LEAST_AREA))) * uvec4(notEqual(here, uvec4(0u)));
        paths[at] = whole((here * holds | unreached * (1u - holds)) * inside);
        before = here;
    }
}
