// The costs that perm_columns.comp leaves with KEEP, bit for bit, for GPUs with few registers per lane (Raspberry
// Pi's V3D): an invocation walks a column with half a slab (8 disparities), and both halves lie in neighbouring lanes.
// Marks are kept for groups of eight rows. On the way up, the lower four rows of a group come first, for which the upper
// four are walked once more.
#include "perm_common.glsl"

layout(local_size_x = LANES) in;
layout(std430, binding = 0) readonly buffer Permeability { uint permeability[]; };  // a byte each of four rows
// Without `readonly`, or else the compiler would read where a value is needed and not where it is written.
layout(std430, binding = 1) buffer Volume { uvec2 volume[]; };
layout(std430, binding = 2) buffer Marks { uvec4 marks[]; };  // the sums from above a group of rows
layout(std430, binding = 3) writeonly buffer Costs { uvec2 costs[]; };  // a byte each, slab after slab
layout(std430, binding = 4) buffer Scale { uint scale[]; };  // 16 bits each, two pixels a word
uniform int plane;  // pixels of a slab of costs
uniform ivec2 size;
uniform int stride;
uniform int first_disparity;

const int group_rows = 8;

// Sums shifted to 8 bits times a factor of the pixel, see perm_weight.comp, in pairs; then four bytes a word.
uvec2 codes_of(uvec4 sums, uint scale) {
    uvec4 codes = ((((sums >> (scale >> 13)) & low_bytes) * (scale & 0x1fffu)) >> 8) & low_bytes;
    codes = (codes | (codes >> 8)) & 0xffffu;
    return codes.xz | (codes.yw << 16);
}

// Row k of a group from the sums that come down to it. What lies below the picture passes nothing on.
#define SUMS_AT(k) volume[(column + min(first + (k), size.y - 1) * block_px) * 2 + part]
#define MU(k) ((four >> (8 * (k))) & 255u)  // of the four rows from `first` on
#define READ uvec2 own0 = SUMS_AT(0), own1 = SUMS_AT(1), own2 = SUMS_AT(2), own3 = SUMS_AT(3);
#define DOWN(k, own) a = pairs_of(own) + permeate(a, MU(k));
#define DOWN_AGAIN(k, own, sum) sum = a = pairs_of(own) + permeate(a, MU(k));
// Rows below the picture are written to its last one, which is written after them.
#define SCALE_AT(k) scale[(min(first + (k), size.y - 1) * stride + x) >> 1]
#define UP(k, own, sum, scale_word)                                                                                    \
    costs[((first_disparity >> 4) * plane + column + min(first + (k), size.y - 1) * block_px) * 2 + part] =            \
        codes_of(sum + up, (scale_word >> scale_bit) & 0xffffu);                                                       \
    up = permeate(up + pairs_of(own), MU(k));

// Always true. A condition ends a block of code that the compiler puts into an order of its own: what is read before it is
// read together, and one wait is for all of it.
#define THEN if (plane > 0)

void main() {
    int x = int(gl_GlobalInvocationID.x >> 1), part = int(gl_GlobalInvocationID.x & 1u);
    if (x >= size.x) return;
    int scale_bit = 16 * (x & 1);  // stride is even
    int column = block_at(x, 0, size.y), groups = (size.y + group_rows - 1) / group_rows;

    uvec4 a = uvec4(0u);
    int fours = (size.y + 3) >> 2;
    for (int k = 0; k < fours; ++k) {
        int first = 4 * k;
        uint four = permeability[k * stride + x];
        READ
        THEN {
            if ((k & 1) == 0) marks[block_at(x, k >> 1, groups) * 2 + part] = a;
            DOWN(0, own0) DOWN(1, own1) DOWN(2, own2) DOWN(3, own3)
        }
    }

    uvec4 up = uvec4(0u);
    for (int k = fours - 1; k >= 0; --k) {
        int group = k >> 1, first = group * group_rows;
        uint four = permeability[(first >> 2) * stride + x];
        a = marks[block_at(x, group, groups) * 2 + part];
        if ((k & 1) != 0) {
            READ
            THEN { DOWN(0, own0) DOWN(1, own1) DOWN(2, own2) DOWN(3, own3) }
            first += 4;
            four = permeability[k * stride + x];
        }
        READ
        uint scale0 = SCALE_AT(0), scale1 = SCALE_AT(1), scale2 = SCALE_AT(2), scale3 = SCALE_AT(3);
        THEN {
            uvec4 sum0, sum1, sum2, sum3;
            DOWN_AGAIN(0, own0, sum0) DOWN_AGAIN(1, own1, sum1) DOWN_AGAIN(2, own2, sum2) DOWN_AGAIN(3, own3, sum3)
            UP(3, own3, sum3, scale3) UP(2, own2, sum2, scale2) UP(1, own1, sum1, scale1) UP(0, own0, sum0, scale0)
        }
    }
}
