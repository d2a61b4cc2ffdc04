// The last pass: 3x3 median of the disparities, into the result. A pixel that is unknown stays so; an unknown
// neighbour votes as the centre does.
#include "stereo_median9.glsl"

layout(std430, binding = 0) readonly buffer Disparity { uint disparity[]; };
uniform ivec2 size;
uniform int stride;
layout(location = 0) out uint result;

uint centre;
uint neighbour(int x, int y) {
    uint d = disparity[clamp(y, 0, size.y - 1) * stride + clamp(x, 0, size.x - 1)] & 0xffffu;
    return d != 0u ? d : centre;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    centre = disparity[at.y * stride + at.x] & 0xffffu;
    result = centre == 0u ? 0u
                          : median9(neighbour(at.x - 1, at.y - 1), neighbour(at.x, at.y - 1),
                                    neighbour(at.x + 1, at.y - 1), neighbour(at.x - 1, at.y), centre,
                                    neighbour(at.x + 1, at.y), neighbour(at.x - 1, at.y + 1),
                                    neighbour(at.x, at.y + 1), neighbour(at.x + 1, at.y + 1));
}
