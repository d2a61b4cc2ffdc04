// Gives the pixels what has come to their cells: those that are unknown, and those of small islands where a path has
// led, for by its limit the other camera does not see them. What is filled has confidence 0. An invocation makes four
// pixels of a row.
#include "path_fill.glsl"
#include "stereo_common.glsl"

#ifndef CELL
#define CELL 2  // px: 1 or 2
#endif

layout(local_size_x = PICTURE_LANES) in;
layout(std430, binding = 0) readonly buffer Disparity { uvec4 disparity[]; };  // uint a pixel: 1/32 px | confidence << 16
layout(std430, binding = 1) writeonly buffer Filled { uvec4 filled[]; };
#if CELL == 1
layout(std430, binding = 2) readonly buffer Paths { uvec4 paths[]; };
#else
layout(std430, binding = 2) readonly buffer Paths { uvec2 paths[]; };
#endif
uniform ivec2 size;  // px
uniform int stride;
uniform int cells_stride;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x * 4 >= size.x || at.y >= size.y) return;
#if CELL == 1
    uvec4 path = paths[(at.y * cells_stride >> 2) + at.x];
#else
    uvec4 path = paths[((at.y >> 1) * cells_stride >> 1) + at.x].xxyy;
#endif
    int pixel = (at.y * stride >> 2) + at.x;
    uvec4 here = disparity[pixel];
    uvec4 replaced = uvec4(equal(here & 0xffffu, uvec4(0u))) |
                     uvec4(greaterThan(path, uvec4(0xffffu))) * uvec4(lessThan(path, uvec4(unreached)));
    filled[pixel] = whole(here * (1u - replaced) + (path & 0xffffu) * replaced);
}
