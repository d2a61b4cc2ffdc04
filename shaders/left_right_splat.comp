// Every right pixel keeps the best of the left pixels that claim it: cost (normalised) << 16 | disparity.
#include "stereo_common.glsl"

// Whether costs must be divided by a weight before those of different pixels are compared.
#ifndef WEIGHTED
#define WEIGHTED 1
#endif

layout(local_size_x = PICTURE_LANES) in;
layout(std430, binding = 0) readonly buffer Winners { uvec2 winners[]; };
#if WEIGHTED
layout(std430, binding = 1) readonly buffer Weight { uint weight[]; };
#define WEIGHT float(max(weight[here], 1u))
#else
#define WEIGHT 16.0
#endif
layout(std430, binding = 2) buffer Claims { uint claims[]; };
uniform ivec2 size;
uniform int stride;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= size.x || at.y >= size.y) return;
    int here = at.y * stride + at.x;
    uint winner = winners[block_at(at.x, at.y, size.y)].x;
    int d = int((winner >> 12) & 255u);
    if (d > at.x) return;
    // Floats: an integer division is taken apart into scalar ones on some GPUs.
    uint cost = min(uint(float((winner >> 20) << 12) / WEIGHT), 0xffffu);
    atomicMin(claims[here - d], (cost << 16) | uint(d));
}
