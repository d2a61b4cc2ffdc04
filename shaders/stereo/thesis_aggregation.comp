// One pass of gradient-guided aggregation over the 3x3 neighbourhood: first along the row, then
// along the column, each with weights chosen by the discontinuities on both sides,
//   none: 3 2 3    before: 0 5 3    after: 3 5 0    both: 0 8 0    (eighths),
// which is to say that a neighbour beyond a discontinuity is replaced by the centre. A 16-bit half
// holds a cost of 10 bits and its sum over both axes (times 64), so that two disparities ride in a
// word; rounding happens once.
#ifndef GROUP_WIDTH
#define GROUP_WIDTH 64
#endif
#ifndef ROWS
#define ROWS 16 // an invocation walks down this many rows and keeps the row sums that it meets again
#endif
layout(local_size_x = GROUP_WIDTH) in;
layout(std430, binding = 0) readonly buffer Costs { uvec4 costs[]; };
layout(std430, binding = 1) readonly buffer Discontinuities { uint discontinuities[]; };
layout(std430, binding = 2) writeonly buffer Aggregated { uvec4 aggregated[]; };
uniform ivec2 size;

uvec4 weigh(uvec4 before, uvec4 centre, uvec4 after) {
    uvec4 sides = before + after;
    return ((sides + centre) << 1) + sides;
}

uvec4 along_row(int index, uint sides) {
    int open_sides = int(~sides);
    return weigh(costs[index - (open_sides & 1)], costs[index],
                 costs[index + ((open_sides >> 1) & 1)]);
}

void main() {
    int x = int(gl_GlobalInvocationID.x);
    if (x >= size.x) return;
    int first = int(gl_GlobalInvocationID.y) * ROWS;
    int end = min(first + ROWS, size.y);
    int slice = int(gl_GlobalInvocationID.z) * size.x * size.y;
    int at = first * size.x + x;
    int upper = max(first - 1, 0) * size.x + x;
    uint sides = discontinuities[at];
    uvec4 above = along_row(slice + upper, discontinuities[upper]);
    uvec4 here = along_row(slice + at, sides);
    for (int y = first; y < end; ++y) {
        int lower = min(y + 1, size.y - 1) * size.x + x;
        uint lower_sides = discontinuities[lower];
        uvec4 below = along_row(slice + lower, lower_sides);
        uvec4 sum = weigh((sides & 4u) != 0u ? here : above, here, (sides & 8u) != 0u ? here : below);
        aggregated[slice + at] = ((sum + 0x00200020u) >> 6) & 0x03ff03ffu;
        above = here;
        here = below;
        sides = lower_sides;
        at = lower;
    }
}
