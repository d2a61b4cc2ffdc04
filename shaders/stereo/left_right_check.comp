// Left-right check and sub-pixel position. An invocation walks a row twice, four pixels a step. A right pixel keeps the
// best of the left pixels that claim it, cost (normalised) << 16 | disparity. Then a left pixel whose claim lost to a
// disparity more than one off is unknown. Leaves disparity in 1/32 px (0 = unknown) and, in the upper half of the word, a
// confidence of 0..255: how sharply the costs rise beside the minimum.
#include "stereo_common.glsl"

// Whether costs must be divided by a weight before those of different pixels are compared.
#ifndef WEIGHTED
#define WEIGHTED 1
#endif

// 1: costs rise only at some distance from their minimum, see Valley of left_right_reference.h.
#ifndef FLAT_VALLEY
#define FLAT_VALLEY 0
#endif

layout(local_size_x = LANES) in;
layout(std430, binding = 0) readonly buffer Winners { uvec4 winners[]; };  // two pixels
#if WEIGHTED
layout(std430, binding = 1) readonly buffer Weight { uvec4 weight[]; };
#define WEIGHTS(at) vec4(max(weight[at], uvec4(1u)))
#else
#define WEIGHTS(at) vec4(16.0)
#endif
layout(std430, binding = 2) buffer Claims { uvec4 claims[]; };
layout(std430, binding = 3) writeonly buffer Disparity { uvec4 disparity[]; };
uniform ivec2 size;
uniform int stride;

#define CLAIM_ON(x) claims[(x) >> 2][(x) & 3]

void stake(int row, int x, uint winner, float weight) {
    int d = int((winner >> 12) & 255u);
    if (d > x || x >= size.x) return;
    uint cost = uint(int(min(float(int(winner >> 20) << 12) / weight, 65535.0)));
    uint before = CLAIM_ON(row + x - d);
    CLAIM_ON(row + x - d) = min(before, (cost << 16) | uint(d));
}

// The whole part of a quotient. Floats, for whole numbers are taken apart into scalar divisions on some GPUs; the half
// keeps a quotient that is whole from coming out a bit below it on others.
int divided(int a, int b) { return int((float(a) + 0.5) / float(b)); }

uint resolved(uvec2 winner, int d) {
    int best = int(winner.x >> 20), before = int(winner.y >> 12), after = int(winner.y & 0xfffu);
    int position = d * 32, rise = 0;
    if (before != 0xfff && after != 0xfff) {
        // Two straight lines of equal steepness through the three costs: what absolute differences give.
        int steep = max(max(before, after) - best, 1);
#if FLAT_VALLEY
        int part = divided(64 * abs(before - after), steep);
        int offset = (part * (96 + part) + 320) / 640;
#else
        int offset = divided(16 * abs(before - after) + (steep >> 1), steep);
#endif
        position += before > after ? offset : -offset;
        rise = before + after - 2 * best;
    } else if (before != 0xfff || after != 0xfff) {
        rise = min(before, after) - best;  // at an end of the search one side alone tells
    }
    int confidence = min(divided(255 * rise, max(best + rise, 1)), 255);
    return uint(max(position, 1)) | (uint(confidence) << 16);
}

uint checked(int row, int x, uvec2 winner) {
    int d = int((winner.x >> 12) & 255u);
    int claimed = int(CLAIM_ON(row + max(x - d, 0)) & 0xffffu);
    return d <= x && abs(claimed - d) <= 1 ? resolved(winner, d) : 0u;
}

void main() {
    int y = int(gl_GlobalInvocationID.x);
    if (y >= size.y) return;
    int row = y * stride;
    for (int x = 0; x < size.x; x += 4) {
        claims[(row + x) >> 2] = uvec4(0xffffffffu);  // no pixel further left claims these
        int at = block_at(x, y, size.y) >> 1;
        uvec4 a = winners[at], b = winners[at + 1];
        vec4 by = WEIGHTS((row + x) >> 2);
        stake(row, x, a.x, by.x);
        stake(row, x + 1, a.z, by.y);
        stake(row, x + 2, b.x, by.z);
        stake(row, x + 3, b.z, by.w);
    }
    for (int x = 0; x < size.x; x += 4) {
        int at = block_at(x, y, size.y) >> 1;
        uvec4 a = winners[at], b = winners[at + 1];
        disparity[(row + x) >> 2] = uvec4(checked(row, x, a.xy), checked(row, x + 1, a.zw), checked(row, x + 2, b.xy),
                                          checked(row, x + 3, b.zw));
    }
}
