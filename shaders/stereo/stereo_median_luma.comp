// 3x3 median of luma and of colour (along z), the guide of the permeability: it takes the noise out and leaves the edges.
#include "stereo_common.glsl"
#include "stereo_median9.glsl"

layout(local_size_x = PICTURE_LANES) in;
layout(std430, binding = 0) readonly buffer Luma { uint luma[]; };
layout(std430, binding = 1) writeonly buffer Guide { uint guide[]; };
uniform ivec2 size;
uniform int row_words;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= row_words || at.y >= size.y) return;
    int here = (at.y + int(gl_GlobalInvocationID.z) * size.y) * row_words + at.x;
    // Where there is no word beside, its nearest pixel repeats.
    int left = at.x > 0 ? -1 : 0, right = at.x + 1 < row_words ? 1 : 0;
    int up = at.y > 0 ? -row_words : 0, down = at.y + 1 < size.y ? row_words : 0;
    uvec3 a = uvec3(luma[here + up + left], luma[here + up], luma[here + up + right]);
    uvec3 b = uvec3(luma[here + left], luma[here], luma[here + right]);
    uvec3 c = uvec3(luma[here + down + left], luma[here + down], luma[here + down + right]);
    uvec3 low = uvec3(left == 0 ? a.y & 255u : a.x >> 24, left == 0 ? b.y & 255u : b.x >> 24,
                      left == 0 ? c.y & 255u : c.x >> 24);
    uvec3 high = uvec3(right == 0 ? a.y >> 24 : a.z & 255u, right == 0 ? b.y >> 24 : b.z & 255u,
                       right == 0 ? c.y >> 24 : c.z & 255u);
    // Columns -1 .. 4 of the four pixels, each as (above, here, below).
    uvec3 words = uvec3(a.y, b.y, c.y);
    uvec3 p0 = words & 255u, p1 = (words >> 8) & 255u, p2 = (words >> 16) & 255u, p3 = words >> 24;
#define MEDIAN(l, m, r) median9(l.x, m.x, r.x, l.y, m.y, r.y, l.z, m.z, r.z)
    uint four = MEDIAN(low, p0, p1) | (MEDIAN(p0, p1, p2) << 8) | (MEDIAN(p1, p2, p3) << 16) |
                (MEDIAN(p2, p3, high) << 24);
    // As whole() does, but of words that may be ~0; no row is without words.
    guide[here] = max(four, uint(row_words == 0));
}
