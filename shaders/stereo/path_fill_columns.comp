// Walks the paths of the fill down the columns and up again. One invocation walks four columns.
#include "path_fill.glsl"
#include "stereo_common.glsl"

#ifndef CELL
#define CELL 2  // px
#endif

layout(local_size_x = LANES) in;
layout(std430, binding = 0) readonly buffer Cells { uvec4 cells[]; };  // limit | luma << 16 | colour << 24
layout(std430, binding = 1) buffer Paths { uvec4 paths[]; };           // see path_fill.glsl
uniform ivec2 size;  // cells
uniform int stride;

void main() {
    int column = int(gl_GlobalInvocationID.x);
    if (column * 4 >= size.x) return;
    int step = stride >> 2, last = column + (size.y - 1) * step;
    uvec4 border = (uvec4(column * 4) + uvec4(1u, 2u, 3u, 4u)) * uint(CELL * 32);
    uvec4 from = uvec4(unreached), from_cell = uvec4(0u);
    for (int at = column; at <= last; at += step) {
        uvec4 cell = cells[at], path = advanced(paths[at], from, cell, from_cell, border);
        paths[at] = path;
        from = path, from_cell = cell;
    }
    from = uvec4(unreached);
    for (int at = last; at >= column; at -= step) {
        uvec4 cell = cells[at], path = advanced(paths[at], from, cell, from_cell, border);
        paths[at] = path;
        from = path, from_cell = cell;
    }
}
