// One iteration of symmetric neighbourhood filtering: of each pair of opposite neighbours in a 3x3
// window the one nearer to the centre's colour is kept, and the four that are kept are averaged.
#ifndef GROUP_WIDTH
#define GROUP_WIDTH 64
#endif
#ifndef ROWS
#define ROWS 16 // an invocation walks down this many rows and keeps the colours that it meets again
#endif
layout(local_size_x = GROUP_WIDTH) in;
layout(std430, binding = 0) readonly buffer Source { uint source[]; };
layout(std430, binding = 1) writeonly buffer Filtered { uint filtered[]; };
uniform ivec2 size;
#include "thesis_picture.glsl"

struct Triple {
    ivec3 left, centre, right;
};

Triple row_around(int x, int y) {
    int row = clamp(y, 0, size.y - 1) * size.x;
    return Triple(colour_of(source[row + max(x - 1, 0)]), colour_of(source[row + x]),
                  colour_of(source[row + min(x + 1, size.x - 1)]));
}

ivec3 nearer(ivec3 a, ivec3 b, ivec3 centre) {
    return colour_distance(a, centre) <= colour_distance(b, centre) ? a : b;
}

void main() {
    int x = int(gl_GlobalInvocationID.x);
    if (x >= size.x) return;
    int first = int(gl_GlobalInvocationID.y) * ROWS;
    int end = min(first + ROWS, size.y);
    Triple above = row_around(x, first - 1);
    Triple here = row_around(x, first);
    for (int y = first; y < end; ++y) {
        Triple below = row_around(x, y + 1);
        ivec3 centre = here.centre;
        ivec3 sum = nearer(here.right, here.left, centre) +
                    nearer(below.centre, above.centre, centre) +
                    nearer(below.right, above.left, centre) +
                    nearer(above.right, below.left, centre);
        uvec3 mean = uvec3((sum + 2) >> 2);
        filtered[y * size.x + x] = mean.x | (mean.y << 8) | (mean.z << 16) | 0xff000000u;
        above = here;
        here = below;
    }
}
