// Cells of the fill, CELL x CELL pixels each: the disparity that most of the cell's pixels share and its mean luma and
// colour. An invocation makes four cells of a row.
#include "path_fill_near.glsl"
#include "stereo_common.glsl"

#ifndef CELL
#define CELL 2  // px: 1 or 2
#endif

layout(local_size_x = PICTURE_LANES) in;
layout(std430, binding = 0) readonly buffer Disparity { uvec4 disparity[]; };  // uint a pixel: 1/32 px | confidence << 16
layout(std430, binding = 1) readonly buffer Luma { uint luma[]; };  // colour's plane behind luma's, see StereoLayout
layout(std430, binding = 2) writeonly buffer Cells { uvec4 cells[]; };  // disparity | luma << 16 | colour << 24
uniform ivec2 size;  // px
uniform int stride;
uniform int luma_row_words;
uniform ivec2 cells_size;
uniform int cells_stride;

uvec4 bytes_of(uint word) { return (uvec4(word) >> uvec4(0u, 8u, 16u, 24u)) & 255u; }

#if CELL == 1
uvec4 shared_disparity(ivec2 at) { return disparity[(at.y * stride >> 2) + at.x] & 0xffffu; }

uvec4 mean_luma(ivec2 at, int plane) { return bytes_of(luma[(plane * size.y + at.y) * luma_row_words + at.x + 1]); }
#else
// Columns 0, 2, 4, 6 and 1, 3, 5, 7 of eight pixels; behind the picture its last column repeats.
void columns_of(int y, int word, out uvec4 even, out uvec4 odd) {
    int row = min(y, size.y - 1) * stride >> 2;
    uvec4 a = disparity[row + word] & 0xffffu, b = disparity[row + min(word + 1, (stride >> 2) - 1)] & 0xffffu;
    even = uvec4(a.xz, b.xz);
    odd = uvec4(a.yw, b.yw);
    if ((size.x & 1) != 0) odd = mix(odd, even, equal(ivec4(word * 4) + ivec4(0, 2, 4, 6), ivec4(size.x - 1)));
}

// Of those with most votes the smallest.
uvec4 better(uvec4 best, uvec4 votes, uvec4 d) { return max(best, (votes << 16) | (0xffffu - d)); }

uvec4 shared_disparity(ivec2 at) {
    uvec4 a, b, c, d;
    columns_of(2 * at.y, 2 * at.x, a, b);
    columns_of(2 * at.y + 1, 2 * at.x, c, d);
    uvec4 ab = are_near(a, b), ac = are_near(a, c), ad = are_near(a, d), bc = are_near(b, c), bd = are_near(b, d),
          cd = are_near(c, d);
    uvec4 best = better(uvec4(0u), ab + ac + ad, a);
    best = better(better(better(best, ab + bc + bd, b), ac + bc + cd, c), ad + bd + cd, d);
    return (0xffffu - (best & 0xffffu)) * uvec4(greaterThan(best, uvec4(0xffffu)));
}

uvec4 mean_luma(ivec2 at, int plane) {
    int above = (plane * size.y + 2 * at.y) * luma_row_words + 2 * at.x + 1;
    int below = (plane * size.y + min(2 * at.y + 1, size.y - 1)) * luma_row_words + 2 * at.x + 1;
    uint first = means_of_2x2(luma[above], luma[below]), second = means_of_2x2(luma[above + 1], luma[below + 1]);
    return uvec4(first & 255u, first >> 16, second & 255u, second >> 16);
}
#endif

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x * 4 >= cells_size.x || at.y >= cells_size.y) return;
    uvec4 inside = uvec4(lessThan(ivec4(at.x * 4) + ivec4(0, 1, 2, 3), ivec4(cells_size.x)));
    cells[(at.y * cells_stride >> 2) + at.x] =
        whole(shared_disparity(at) * inside | (mean_luma(at, 0) << 16) | (mean_luma(at, 1) << 24));
}
