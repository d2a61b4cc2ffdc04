// The sum that the largest cost everywhere would have: what a pixel's aggregated costs must be divided by before they
// are compared with another pixel's. ALONG 0 walks rows and fills the buffer, ALONG 1 then walks columns. With MOST, ALONG 1
// leaves in place of a weight how sums become costs of at most MOST, which is where every cost is the largest: shift << 13 | factor,
// cost = (sum >> shift) * factor >> 8; and the buffer has 16 bits per pixel.
#include "stereo_common.glsl"

#ifndef MOST
#define MOST 0
#endif
#ifndef ALONG
#define ALONG 0
#endif

layout(local_size_x = LANES) in;
const uint most_cost = 31u;
uniform ivec2 size;
uniform int stride;

// Four pixels' weights.
#if MOST
layout(std430, binding = 1) buffer Weight { uvec2 weight[]; };
uvec4 weights_at(int at) {
    uvec2 two = weight[at];
    return uvec4(two & 0xffffu, two >> 16).xzyw;
}
void leave(int at, uvec4 weights) { weight[at] = weights.xz | (weights.yw << 16); }
#else
layout(std430, binding = 1) buffer Weight { uvec4 weight[]; };
uvec4 weights_at(int at) { return weight[at]; }
void leave(int at, uvec4 weights) { weight[at] = weights; }
#endif

#if ALONG == 0
layout(std430, binding = 0) readonly buffer Permeability { uint permeability[]; };  // a byte each

uvec4 permeabilities(int at) {
    uint four = permeability[at];
    return uvec4(four, four >> 8, four >> 16, four >> 24) & 255u;
}

void main() {
    int y = int(gl_GlobalInvocationID.x);
    if (y >= size.y) return;
    int first = y * stride / 4, last = first + (size.x - 1) / 4;
    uvec4 a = uvec4(0u);
    for (int at = first; at <= last; ++at) {
        uvec4 mu = permeabilities(at);
        a.x = most_cost + ((a.w * mu.x) >> 4);
        a.y = most_cost + ((a.x * mu.y) >> 4);
        a.z = most_cost + ((a.y * mu.z) >> 4);
        a.w = most_cost + ((a.z * mu.w) >> 4);
        leave(at, a);
    }
    uint back = 0u, mu_after = 0u;  // nothing passes from behind the picture
    for (int at = last; at >= first; --at) {
        uvec4 mu = permeabilities(at), b;
        b.w = (back * mu_after) >> 4;
        b.z = ((b.w + most_cost) * mu.w) >> 4;
        b.y = ((b.z + most_cost) * mu.z) >> 4;
        b.x = ((b.y + most_cost) * mu.y) >> 4;
        leave(at, (weights_at(at) + b) >> 3);
        back = b.x + most_cost;
        mu_after = mu.x;
    }
}
#else
layout(std430, binding = 0) readonly buffer Permeability { uvec4 permeability[]; };  // a byte each of four rows

// Four columns an invocation; on the way down four rows a step, whose words are read together. A row below the picture is the
// last one once more.
void main() {
    int x = int(gl_GlobalInvocationID.x), step = stride / 4, last = size.y - 1;
    if (x * 4 >= size.x) return;
#define AT(row) (clamp(row, 0, last) * step + x)
#define MU(k) ((four >> (8 * (k))) & 255u)
    uvec4 a = uvec4(0u);
    for (int y = 0; y <= last; y += 4) {
        uvec4 four = permeability[(y >> 2) * step + x];
        uvec4 w0 = weights_at(AT(y)), w1 = weights_at(AT(y + 1)), w2 = weights_at(AT(y + 2)), w3 = weights_at(AT(y + 3));
        w0 += (a * MU(0)) >> 4;
        w1 = y + 1 <= last ? w1 + ((w0 * MU(1)) >> 4) : w0;
        w2 = y + 2 <= last ? w2 + ((w1 * MU(2)) >> 4) : w1;
        a = y + 3 <= last ? w3 + ((w2 * MU(3)) >> 4) : w2;
        leave(AT(y), w0);
        leave(AT(y + 1), w1);
        leave(AT(y + 2), w2);
        leave(AT(y + 3), a);
    }
    uvec4 back = uvec4(0u);
    for (int y = last; y >= 0; --y) {
        uvec4 mu = (permeability[(y >> 2) * step + x] >> (8 * (y & 3))) & 255u, above = weights_at(AT(y - 1));
#if MOST
        ivec4 sum = ivec4(a + back);
        ivec4 shift = ivec4(greaterThanEqual(sum, ivec4(256))) + ivec4(greaterThanEqual(sum, ivec4(512))) +
                      ivec4(greaterThanEqual(sum, ivec4(1024))) + ivec4(greaterThanEqual(sum, ivec4(2048)));
        vec4 factor = float(MOST) * 256.0 * vec4(ivec4(1) << shift) / vec4(max(sum, ivec4(1)));
        leave(AT(y), uvec4(shift << 13) | uvec4(ivec4(factor)));
#else
        leave(AT(y), a + back);
#endif
        back = ((back + a - ((above * mu) >> 4)) * mu) >> 4;
        a = above;
    }
}
#endif
