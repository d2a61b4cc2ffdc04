// Left-right check and sub-pixel position: disparity in 1/32 px (0 = unknown) and, in the upper half of the word,
// a confidence of 0..255: how sharply the costs rise beside the minimum.
#include "stereo_common.glsl"

layout(local_size_x = PICTURE_LANES) in;
layout(std430, binding = 0) readonly buffer Winners { uvec2 winners[]; };
layout(std430, binding = 1) readonly buffer Claims { uint claims[]; };
layout(std430, binding = 2) writeonly buffer Disparity { uint disparity[]; };
uniform ivec2 size;
uniform int stride;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= size.x || at.y >= size.y) return;
    int here = at.y * stride + at.x;
    uvec2 winner = winners[block_at(at.x, at.y, size.y)];
    int d = int((winner.x >> 12) & 255u), best = int(winner.x >> 20);
    int before = int(winner.y >> 12), after = int(winner.y & 0xfffu);
    uint result = 0u;
    if (d <= at.x && abs(int(claims[here - d] & 0xffffu) - d) <= 1) {
        int position = d * 32, rise = 0;
        if (before != 0xfff && after != 0xfff) {
            // Two straight lines of equal steepness through the three costs: what absolute differences give.
            int steep = max(max(before, after) - best, 1);
            int offset = int(float(16 * abs(before - after) + (steep >> 1)) / float(steep));
            position += before > after ? offset : -offset;
            rise = before + after - 2 * best;
        }
        uint confidence = uint(min(float(255 * rise) / float(max(best + rise, 1)), 255.0));
        result = uint(max(position, 1)) | (confidence << 16);
    }
    disparity[here] = result;
}
