// The paths of sgm_path.comp, bit for bit, for search ranges that do not fit into the registers of a lane of a Raspberry
// Pi's V3D. The values of the pixel before lie in memory, 16 disparities a piece, and stay in the cache: a lane holds
// one piece at a time.
#include "stereo_common.glsl"
#include "winner_takes_all.glsl"

#ifndef ALONG
#define ALONG 0
#endif
#ifndef ADD
#define ADD 0
#endif
#ifndef DECIDE
#define DECIDE 1
#endif
#ifndef SLABS
#define SLABS 1  // of 16 disparities, 1..16
#endif
#ifndef VALID
#define VALID 16  // disparities of the last slab that count
#endif
#ifndef P1
#define P1 4
#endif
#ifndef P2
#define P2 20
#endif

layout(local_size_x = LANES) in;
layout(std430, binding = 0) readonly buffer Costs { uvec4 costs[]; };  // see sgm_path.comp, as all up to `sum_rows`
layout(std430, binding = 1) buffer Sums { uvec4 sums[]; };
layout(std430, binding = 2) writeonly buffer Winners { uvec2 winners[]; };
layout(std430, binding = 3) buffer Paths { uvec4 paths[]; };  // of the pixel before: a slab of all lines, slab after slab
uniform ivec2 size;
uniform int plane;
uniform int first_row;
uniform int sum_rows;
uniform int path_lines;  // lines of a slab of paths
uniform int first_line;

const uint ones = 0x01010101u, high = 0x80808080u, low_bytes = 0x00ff00ffu;
const uint edge = uint(P2) * ones;

uvec4 least4(uvec4 a, uvec4 b) {
    uvec4 ahead = (a | high) - b, over = ahead & high;
    return a - (ahead & (over - (over >> 7)));
}
uint least1(uint a, uint b) {
    uint ahead = (a | high) - b, over = ahead & high;
    return a - (ahead & (over - (over >> 7)));
}
uint least_byte(uint four) { return min(min(four & 255u, (four >> 8) & 255u), min((four >> 16) & 255u, four >> 24)); }

#define NONE(w) (VALID <= 4 * w ? ~0u : VALID >= 4 * w + 4 ? 0u : ~0u << (8 * ((VALID - 4 * w) & 3)))
const uvec4 none = uvec4(NONE(0), NONE(1), NONE(2), NONE(3)) & 0x7f7f7f7fu;

int line, slabs;
uint most;  // the least value of the pixel before, in every byte

// Values of the pixel before in the form that the step takes.
uvec4 before_at(int slab) { return least4(paths[slab * path_lines + line] - most, uvec4(edge)); }

void start() {
    most = 0u;
    for (int k = 0; k < slabs; ++k) paths[k * path_lines + line] = uvec4(0u);
}

// The rest of a slab that is walked on the way back. s: the sums that are there already.
void take(int slab, uvec4 q, uvec4 s) {
    uvec4 even = (s & low_bytes) + (q & low_bytes), odd = ((s >> 8) & low_bytes) + ((q >> 8) & low_bytes);
    uvec4 lower = (even & 0xffffu) | (odd << 16), upper = (even >> 16) | (odd & 0xffff0000u);
    consider_slab(16 * slab, uvec4(lower.x, upper.x, lower.y, upper.y), uvec4(lower.z, upper.z, lower.w, upper.w),
                  VALID == 16 || slab < SLABS - 1 ? 16 : VALID);
}

// A pixel of a path, whose costs begin at `from` and whose sums begin at `at`.
#define STEP(leave)                                                                              \
    {                                                                                            \
        uint carry = edge, least = 0x7f7f7f7fu;                                                  \
        uvec4 here = before_at(0);                                                               \
        for (int k = 0; k < slabs; ++k) {                                                        \
            uvec4 next = k + 1 < slabs ? before_at(k + 1) : uvec4(edge);                         \
            uvec4 below = (here << 8) | (uvec4(carry, here.xyz) >> 24);                          \
            uvec4 above = (here >> 8) | (uvec4(here.yzw, next.x) << 24);                         \
            carry = here.w;                                                                      \
            uvec4 q = costs[from + k * plane] + least4(here, least4(below, above) + uint(P1) * ones); \
            if (VALID < 16 && k == SLABS - 1) q |= none;                                         \
            paths[k * path_lines + line] = q;                                                    \
            least = least1(least, least1(least1(q.x, q.y), least1(q.z, q.w)));                   \
            leave                                                                                \
            here = next;                                                                         \
        }                                                                                        \
        most = least_byte(least) * ones;                                                         \
    }

void main() {
    line = first_line + int(gl_GlobalInvocationID.x);
    slabs = SLABS + min(plane, 0);  // SLABS, and loops that the compiler does not unroll
#if ALONG == 0
    int y = line + first_row, count = size.x;
    if (y >= min(first_row + sum_rows, size.y)) return;
#define GO_TO(i)                              \
    int pixel = block_at(i, y, size.y);       \
    int from = pixel;                         \
    int at = block_at(i, y - first_row, sum_rows) * SLABS;
#else
    int x = line, count = size.y;
    if (x >= size.x) return;
#define GO_TO(i)                              \
    int pixel = block_at(x, i, size.y);       \
    int from = pixel;                         \
    int at = pixel * SLABS;
#endif

    start();
    for (int i = 0; i < count; ++i) {
        GO_TO(i)
#if ADD
        STEP(sums[at + k] += q;)
#else
        STEP(sums[at + k] = q;)
#endif
    }

    start();
    for (int i = count - 1; i >= 0; --i) {
        GO_TO(i)
#if DECIDE
        no_winner_yet();
        STEP(take(k, q, sums[at + k]);)
        winners[pixel] = winner();
#else
        STEP(sums[at + k] += q;)
#endif
    }
}
