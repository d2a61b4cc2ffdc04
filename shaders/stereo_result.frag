// The last pass: 3x3 median of the disparities, into the result. A pixel that is unknown stays so; an unknown
// neighbour votes as the centre does. With CONFIDENCE 1 also how sure each is.
#include "stereo_median9.glsl"

#ifndef CONFIDENCE
#define CONFIDENCE 0
#endif

layout(std430, binding = 0) readonly buffer Disparity { uint disparity[]; };
uniform ivec2 size;
uniform int stride;
layout(location = 0) out uint result;
#if CONFIDENCE
layout(location = 1) out uint confidence;
#endif

uint centre;
uint vote(int row, int x) {
    uint d = disparity[row + clamp(x, 0, size.x - 1)] & 0xffffu;
    return d != 0u ? d : centre;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    int row = at.y * stride, above = max(at.y - 1, 0) * stride, below = min(at.y + 1, size.y - 1) * stride;
    uint word = disparity[row + at.x];
    centre = word & 0xffffu;
    result = centre == 0u ? 0u
                          : median9(vote(above, at.x - 1), vote(above, at.x), vote(above, at.x + 1),
                                    vote(row, at.x - 1), centre, vote(row, at.x + 1), vote(below, at.x - 1),
                                    vote(below, at.x), vote(below, at.x + 1));
#if CONFIDENCE
    confidence = word >> 16;
#endif
}
