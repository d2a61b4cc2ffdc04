// Left-right check and sub-pixel position. An invocation walks a row three times: every right pixel has no claim yet;
// it keeps the best of the left pixels that claim it, cost (normalised) << 16 | disparity; then a left pixel whose
// claim lost to a disparity more than one off is unknown. Leaves disparity in 1/32 px (0 = unknown) and, in the upper
// half of the word, a confidence of 0..255: how sharply the costs rise beside the minimum.
#include "stereo_common.glsl"

// Whether costs must be divided by a weight before those of different pixels are compared.
#ifndef WEIGHTED
#define WEIGHTED 1
#endif

layout(local_size_x = LANES) in;
layout(std430, binding = 0) readonly buffer Winners { uvec2 winners[]; };
#if WEIGHTED
layout(std430, binding = 1) readonly buffer Weight { uint weight[]; };
#define WEIGHT(at) float(max(weight[at], 1u))
#else
#define WEIGHT(at) 16.0
#endif
layout(std430, binding = 2) buffer Claims { uint claims[]; };
layout(std430, binding = 3) writeonly buffer Disparity { uint disparity[]; };
uniform ivec2 size;
uniform int stride;

// Floats where one would divide whole numbers: that is taken apart into scalar divisions on some GPUs.
uint resolved(uvec2 winner, int d) {
    int best = int(winner.x >> 20), before = int(winner.y >> 12), after = int(winner.y & 0xfffu);
    int position = d * 32, rise = 0;
    if (before != 0xfff && after != 0xfff) {
        // Two straight lines of equal steepness through the three costs: what absolute differences give.
        int steep = max(max(before, after) - best, 1);
        int offset = int(float(16 * abs(before - after) + (steep >> 1)) / float(steep));
        position += before > after ? offset : -offset;
        rise = before + after - 2 * best;
    }
    int confidence = int(min(float(255 * rise) / float(max(best + rise, 1)), 255.0));
    return uint(max(position, 1)) | (uint(confidence) << 16);
}

void main() {
    int y = int(gl_GlobalInvocationID.x);
    if (y >= size.y) return;
    int row = y * stride;
    for (int x = 0; x < size.x; ++x) claims[row + x] = 0xffffffffu;
    for (int x = 0; x < size.x; ++x) {
        uint winner = winners[block_at(x, y, size.y)].x;
        int d = int((winner >> 12) & 255u);
        if (d > x) continue;
        uint cost = uint(int(min(float(int(winner >> 20) << 12) / WEIGHT(row + x), 65535.0)));
        claims[row + x - d] = min(claims[row + x - d], (cost << 16) | uint(d));
    }
    for (int x = 0; x < size.x; ++x) {
        uvec2 winner = winners[block_at(x, y, size.y)];
        int d = int((winner.x >> 12) & 255u);
        int claimed = int(claims[row + max(x - d, 0)] & 0xffffu);
        bool holds = d <= x && abs(claimed - d) <= 1;
        disparity[row + x] = holds ? resolved(winner, d) : 0u;
    }
}
