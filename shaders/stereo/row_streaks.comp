// Makes streaks unknown: a few rows of a column that differ from the one surface above and below them, where that
// surface matches as well. One invocation walks four columns down; whatever it clears lies behind it.
#include "path_fill_near.glsl"
#include "stereo_common.glsl"

#ifndef DISPARITIES
#define DISPARITIES 16
#endif
#ifndef MOST_ROWS
#define MOST_ROWS 16
#endif
#ifndef MOST_GAIN
#define MOST_GAIN 12u
#endif
#ifndef LEAST_VALLEY
#define LEAST_VALLEY 8u
#endif

layout(local_size_x = LANES) in;
layout(std430, binding = 0) buffer Disparity { uvec4 disparity[]; };  // 1/32 px | confidence << 16
layout(std430, binding = 1) readonly buffer Costs { uint costs[]; };  // 16 bytes a pixel, slab after slab
uniform ivec2 size;
uniform int stride;
uniform int plane;  // pixels of a slab of costs

uint cost_at(int pixel, int d) {
    const uint beyond_search = 255u;
    int within = clamp(d, 0, DISPARITIES - 1);
    uint cost = byte_of(costs[((within >> 4) * plane + pixel) * 4 + ((within >> 2) & 3)], within & 3);
    return within == d ? cost : beyond_search;
}
// The lesser cost of the two whole disparities around one, and of those two pixels off.
uint around(int pixel, uint d) { return min(cost_at(pixel, int(d >> 5)), cost_at(pixel, int(d >> 5) + 1)); }
uint beside(int pixel, uint d) { return min(cost_at(pixel, int(d >> 5) - 2), cost_at(pixel, int(d >> 5) + 3)); }

bool is_streak(int pixel, uint d, uint surface) {
    uint expected = around(pixel, surface);
    return d != 0u && expected <= around(pixel, d) + MOST_GAIN && expected + LEAST_VALLEY <= beside(pixel, surface);
}

#define JUDGE(c, k)                                                                                                  \
    if ((judged & (1u << k)) != 0u)                                                                                  \
        for (uint row = first_row.c; row <= last_row.c; ++row) {                                                     \
            int place = column + int(row) * step;                                                                    \
            if (is_streak(block_at(column * 4 + k, int(row), size.y), disparity[place].c & 0xffffu,                  \
                          (above.c + here.c) >> 1))                                                                  \
                disparity[place].c = 0u;                                                                             \
        }

#define GO_ON                                    \
    above += (bottom - above) * begins;          \
    first_row += (uint(y) - first_row) * begins; \
    last_row += (uint(y) - last_row) * known;    \
    bottom += (here - bottom) * known;

void main() {
    int column = int(gl_GlobalInvocationID.x);
    if (column * 4 >= size.x) return;
    int step = stride >> 2;
    // The runs that the walk is in, and what ended right above them.
    uvec4 above = uvec4(0u), bottom = uvec4(0u), first_row = uvec4(0u), last_row = uvec4(0u);
    uvec4 here, known, begins;
    uint judged;  // a bit for each of the four columns
    int y = 0, at = column;
    while (y < size.y) {
        // llvmpipe goes through what a condition leaves out, and jumps at the end of a loop only: in this one is
        // what every step needs.
        for (; y < size.y; ++y, at += step) {
            here = disparity[at] & 0xffffu;
            here *= uvec4(lessThan(ivec4(column * 4) + ivec4(0, 1, 2, 3), ivec4(size.x)));
            known = uvec4(notEqual(here, uvec4(0u)));
            begins = known * (1u - are_near(bottom, here));
            uvec4 ends =
                begins * are_near(above, here) * uvec4(lessThan(last_row - first_row, uvec4(uint(MOST_ROWS))));
            judged = ends.x | (ends.y << 1) | (ends.z << 2) | (ends.w << 3);
            if (judged != 0u) break;
            GO_ON
        }
        JUDGE(x, 0) JUDGE(y, 1) JUDGE(z, 2) JUDGE(w, 3)
        GO_ON
        ++y;
        at += step;
    }
}
