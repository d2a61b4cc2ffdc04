// Leaves only the disparities that enough of the 25 pixels at every second place around them share: what is found in
// an occluded stripe by chance stands alone, and a fill would spread it. One invocation a pixel.
#include "stereo_common.glsl"

layout(local_size_x = PICTURE_LANES) in;
layout(std430, binding = 0) readonly buffer Disparity { uint disparity[]; };
layout(std430, binding = 1) writeonly buffer Supported { uint supported[]; };
uniform ivec2 size;
uniform int stride;
uniform int least_votes;

void main() {
    int x = int(gl_GlobalInvocationID.x), y = int(gl_GlobalInvocationID.y);
    if (x >= size.x || y >= size.y) return;
    uint word = disparity[y * stride + x];
    int centre = int(word & 0xffffu), votes = 0;
    if (centre != 0) {
        for (int dy = -4; dy <= 4; dy += 2) {
            int row = clamp(y + dy, 0, size.y - 1) * stride;
            for (int dx = -4; dx <= 4; dx += 2) {
                int vote = int(disparity[row + clamp(x + dx, 0, size.x - 1)] & 0xffffu);
                votes += vote != 0 && abs(vote - centre) <= 32 ? 1 : 0;
            }
        }
    }
    supported[y * stride + x] = votes >= least_votes ? word : 0u;
}
