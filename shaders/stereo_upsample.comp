// Twice the size: each pixel takes the disparity of that one of the five nearest coarse pixels which is near, looks
// most like it, and matches best at full size, so that depth edges move to where they are. One invocation a coarse
// pixel, 2x2 results.
#include "perm_common.glsl"

layout(local_size_x = PICTURE_LANES) in;
layout(std430, binding = 0) readonly buffer CoarseDisparity { uint coarse_disparity[]; };
layout(std430, binding = 1) readonly buffer CoarseLuma { uint coarse_luma[]; };
layout(std430, binding = 2) readonly buffer FineLuma { uint fine_luma[]; };
layout(std430, binding = 3) writeonly buffer FineDisparity { uint fine_disparity[]; };
layout(std430, binding = 4) readonly buffer LeftFeatures { uint left_features[]; };
layout(std430, binding = 5) readonly buffer RightFeatures { uint right_features[]; };
uniform ivec2 coarse_size;
uniform int coarse_stride;
uniform int coarse_row_words;
uniform ivec2 fine_size;
uniform int fine_stride;
uniform int fine_row_words;

// A candidate is as unlike as it is far (in quarters of a coarse pixel), looks different, and matches badly.
#define TRY(d, l, far)                                                                            \
    {                                                                                             \
        int x_right = x - int(((d & 0xffffu) + 8u) >> 4);                                         \
        uint right = x_right >= 0 ? right_features[row + max(x_right, 0)] : outside_word;         \
        int unlike = abs(luma - (l)) + (far) + 3 * int(cost_of(left, right));                     \
        if (unlike < least) best = (d);                                                           \
        least = min(least, unlike);                                                               \
    }

// For the pixel at x, y, offset (i, j) in the 2x2; x: left or above, y: here, z: right or below.
uint choose(int luma, int x, int y, int i, int j, uvec3 across, uvec3 down, ivec3 across_luma, ivec3 down_luma) {
    int left_far = i == 0 ? 4 : 6, right_far = 10 - left_far, above_far = j == 0 ? 4 : 6, below_far = 10 - above_far;
    int row = y * fine_stride;
    uint left = left_features[row + x];
    int least = 1 << 20;
    uint best = 0u;
    TRY(across.y, across_luma.y, 2)
    TRY(down.x, down_luma.x, above_far)
    TRY(down.z, down_luma.z, below_far)
    TRY(across.x, across_luma.x, left_far)
    TRY(across.z, across_luma.z, right_far)
    return (best & 0xffff0000u) | ((best & 0xffffu) << 1);
}

uint disparity_at(int x, int y) { return coarse_disparity[clamp(y, 0, coarse_size.y - 1) * coarse_stride + clamp(x, 0, coarse_size.x - 1)]; }
int luma_at(int x, int y) {
    // The edge is repeated before and behind each row.
    return int(byte_of(coarse_luma[clamp(y, 0, coarse_size.y - 1) * coarse_row_words + (x + 4 >> 2)], (x + 4) & 3));
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= coarse_size.x || at.y >= coarse_size.y) return;
    uint here = disparity_at(at.x, at.y);
    uvec3 across = uvec3(disparity_at(at.x - 1, at.y), here, disparity_at(at.x + 1, at.y));
    uvec3 down = uvec3(disparity_at(at.x, at.y - 1), here, disparity_at(at.x, at.y + 1));
    int luma_here = luma_at(at.x, at.y);
    ivec3 across_luma = ivec3(luma_at(at.x - 1, at.y), luma_here, luma_at(at.x + 1, at.y));
    ivec3 down_luma = ivec3(luma_at(at.x, at.y - 1), luma_here, luma_at(at.x, at.y + 1));
    int x = 2 * at.x;
    for (int j = 0; j < 2; ++j) {
        int y = 2 * at.y + j;
        if (y >= fine_size.y) return;
        uint lumas = fine_luma[y * fine_row_words + (x >> 2) + 1];
        int first = x & 3, out_at = y * fine_stride + x;
        // A column beyond the last one lands in the padding of the row.
        fine_disparity[out_at] = choose(int(byte_of(lumas, first)), x, y, 0, j, across, down, across_luma, down_luma);
        fine_disparity[out_at + 1] = choose(int(byte_of(lumas, first + 1)), x + 1, y, 1, j, across, down, across_luma, down_luma);
    }
}
