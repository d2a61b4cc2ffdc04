// Twice the size: each pixel takes the disparity of that one of the nine nearest coarse pixels which looks most like
// it and is near, so that depth edges move to the edges of the picture. One invocation a coarse pixel, 2x2 results.
#include "stereo_common.glsl"

layout(local_size_x = PICTURE_LANES) in;
layout(std430, binding = 0) readonly buffer CoarseDisparity { uint coarse_disparity[]; };
layout(std430, binding = 1) readonly buffer CoarseLuma { uint coarse_luma[]; };
layout(std430, binding = 2) readonly buffer FineLuma { uint fine_luma[]; };
layout(std430, binding = 3) writeonly buffer FineDisparity { uint fine_disparity[]; };
uniform ivec2 coarse_size;
uniform int coarse_stride;
uniform int coarse_row_words;
uniform ivec2 fine_size;
uniform int fine_stride;
uniform int fine_row_words;

uvec3 disparities_of(int x, int y) {
    int row = clamp(y, 0, coarse_size.y - 1) * coarse_stride;
    return uvec3(coarse_disparity[row + max(x - 1, 0)], coarse_disparity[row + x],
                 coarse_disparity[row + min(x + 1, coarse_size.x - 1)]);
}
ivec3 lumas_of(int x, int y) {
    int word = clamp(y, 0, coarse_size.y - 1) * coarse_row_words + (x >> 2) + 1, i = x & 3;
    uint here = coarse_luma[word];
    uint beside = i == 0 ? coarse_luma[word - 1] : i == 3 ? coarse_luma[word + 1] : here;
    return ivec3(byte_of(i == 0 ? beside : here, (i + 3) & 3), byte_of(here, i), byte_of(i == 3 ? beside : here, (i + 1) & 3));
}

// Disparity for the fine pixel with offset (i, j) in the 2x2; distances in quarters of a coarse pixel.
#define TRY(d, l, far)                           \
    {                                            \
        int unlike = abs(luma - (l)) + (far);    \
        if (unlike < least) best = (d);          \
        least = min(least, unlike);              \
    }

uint choose(int luma, int i, int j, uvec3 da, uvec3 db, uvec3 dc, ivec3 la, ivec3 lb, ivec3 lc) {
    int left = i == 0 ? 3 : 5, right = 8 - left, up = j == 0 ? 3 : 5, down = 8 - up;
    int least = abs(luma - lb.y) + 2;
    uint best = db.y;
    TRY(da.x, la.x, left + up) TRY(da.y, la.y, 1 + up) TRY(da.z, la.z, right + up)
    TRY(db.x, lb.x, left + 1) TRY(db.z, lb.z, right + 1)
    TRY(dc.x, lc.x, left + down) TRY(dc.y, lc.y, 1 + down) TRY(dc.z, lc.z, right + down)
    return (best & 0xffff0000u) | ((best & 0xffffu) << 1);
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= coarse_size.x || at.y >= coarse_size.y) return;
    uvec3 da = disparities_of(at.x, at.y - 1), db = disparities_of(at.x, at.y), dc = disparities_of(at.x, at.y + 1);
    ivec3 la = lumas_of(at.x, at.y - 1), lb = lumas_of(at.x, at.y), lc = lumas_of(at.x, at.y + 1);
    int x = 2 * at.x, y = 2 * at.y, first = x & 3;
    // A column or row beyond the last one lands in the padding of the row, or is left out.
    int lower = min(y + 1, fine_size.y - 1);
    uint above = fine_luma[y * fine_row_words + (x >> 2) + 1];
    uint below = fine_luma[lower * fine_row_words + (x >> 2) + 1];
    int out_above = y * fine_stride + x, out_below = lower * fine_stride + x;
    uint below_left = choose(int(byte_of(below, first)), 0, 1, da, db, dc, la, lb, lc);
    uint below_right = choose(int(byte_of(below, first + 1)), 1, 1, da, db, dc, la, lb, lc);
    if (lower > y) {
        fine_disparity[out_below] = below_left;
        fine_disparity[out_below + 1] = below_right;
    }
    fine_disparity[out_above] = choose(int(byte_of(above, first)), 0, 0, da, db, dc, la, lb, lc);
    fine_disparity[out_above + 1] = choose(int(byte_of(above, first + 1)), 1, 0, da, db, dc, la, lb, lc);
}
