// Walks the paths of the fill along the rows, one invocation each, four cells a step. The first time it finds each
// cell's limit on the way: a cell that one of its right neighbours hides from the right camera has at most that one's
// disparity less their distance. A row without sources takes all that is known for one. The LAST time, what no path has
// come to takes the smaller of the nearest disparities to its left and right, the background.
#include "path_fill.glsl"
#include "stereo_common.glsl"

#ifndef LAST
#define LAST 0
#endif
#ifndef CELL
#define CELL 2  // px
#endif

layout(local_size_x = LANES) in;
layout(std430, binding = 0) buffer Cells { uvec4 cells[]; };  // disparity, after the first time limit | luma << 16 | colour << 24
layout(std430, binding = 1) buffer Paths { uvec4 paths[]; };  // see path_fill.glsl
uniform ivec2 size;  // cells
uniform int stride;

const uint cell_width = uint(CELL) * 32u;  // 1/32 px

uint from, from_cell, border;
#define STEP(path, cell, to_border)                            \
    path = advanced(path, from, cell, from_cell, border);      \
    from = path, from_cell = cell, border to_border cell_width;

void walk_right(int first, int last) {
    from = unreached, from_cell = 0u, border = cell_width;
    for (int at = first; at <= last; ++at) {
        uvec4 path = paths[at], cell = cells[at];
        STEP(path.x, cell.x, +=) STEP(path.y, cell.y, +=) STEP(path.z, cell.z, +=) STEP(path.w, cell.w, +=)
        paths[at] = path;
    }
}

#if LAST
uint known;
// What has come to a cell, or else the nearest that has come to one on the side one walks from.
#define FROM_RIGHT(path) \
    known = path < unreached && path != 0u ? path & 0xffffu : known; \
    path = path == unreached ? unreached | known : path;
#define FROM_LEFT(path)                                                            \
    if (path < unreached) {                                                        \
        known = path & 0xffffu;                                                    \
    } else {                                                                       \
        uint right = path & 0xffffu;                                               \
        path = unreached | (known != 0u && right != 0u ? min(known, right) : max(known, right)); \
    }

void main() {
    int y = int(gl_GlobalInvocationID.x);
    if (y >= size.y) return;
    int first = y * stride / 4, last = first + (size.x - 1) / 4;
    walk_right(first, last);
    from = unreached, from_cell = 0u, known = 0u;
    border = uint(last - first + 1) * 4u * cell_width;
    for (int at = last; at >= first; --at) {
        uvec4 path = paths[at], cell = cells[at];
        STEP(path.w, cell.w, -=) STEP(path.z, cell.z, -=) STEP(path.y, cell.y, -=) STEP(path.x, cell.x, -=)
        FROM_RIGHT(path.w) FROM_RIGHT(path.z) FROM_RIGHT(path.y) FROM_RIGHT(path.x)
        paths[at] = path;
    }
    known = 0u;
    for (int at = first; at <= last; ++at) {
        uvec4 path = paths[at];
        FROM_LEFT(path.x) FROM_LEFT(path.y) FROM_LEFT(path.z) FROM_LEFT(path.w)
        paths[at] = path;
    }
}
#else
uint limit;
#define LIMIT(path, cell)                                                             \
    cell = (cell & 0xffff0000u) | limit;                                              \
    limit = max(max(limit, path < unreached ? path & 0xffffu : 0u), cell_width) - cell_width; \
    STEP(path, cell, -=)

bool has_source(int first, int last) {
    for (int at = first; at <= last; ++at)
        if (any(lessThan(paths[at] - 1u, uvec4(unreached - 1u)))) return true;
    return false;
}

void main() {
    int y = int(gl_GlobalInvocationID.x);
    if (y >= size.y) return;
    int first = y * stride / 4, last = first + (size.x - 1) / 4;
    if (!has_source(first, last))
        for (int at = first; at <= last; ++at) {
            uvec4 d = cells[at] & 0xffffu;
            paths[at] = d + paths[at] * uvec4(equal(d, uvec4(0u)));
        }
    from = unreached, from_cell = 0u, limit = 0u;
    border = uint(last - first + 1) * 4u * cell_width;
    for (int at = last; at >= first; --at) {
        uvec4 path = paths[at], cell = cells[at];
        LIMIT(path.w, cell.w) LIMIT(path.z, cell.z) LIMIT(path.y, cell.y) LIMIT(path.x, cell.x)
        cells[at] = cell;
        paths[at] = path;
    }
    walk_right(first, last);
}
#endif
