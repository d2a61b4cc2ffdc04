// The sum that a cost of 16 everywhere would have: what a pixel's aggregated costs must be divided by before they
// are compared with another pixel's. ALONG 0 walks rows and fills the buffer, ALONG 1 then walks columns.
#include "stereo_common.glsl"

#ifndef ALONG
#define ALONG 0
#endif

layout(local_size_x = LANES) in;
layout(std430, binding = 0) readonly buffer Permeability { uint permeability[]; };
layout(std430, binding = 1) buffer Weight { uint weight[]; };
uniform ivec2 size;
uniform int stride;

void main() {
    int line = int(gl_GlobalInvocationID.x);
#if ALONG == 0
    if (line >= size.y) return;
    int first = line * stride, step_px = 1, count = size.x;
    const uint shift = 0u, scale = 3u;
#else
    if (line >= size.x) return;
    int first = line, step_px = stride, count = size.y;
    const uint shift = 4u, scale = 0u;
#endif
    uint a = 0u;
    for (int i = 0; i < count; ++i) {
        int at = first + i * step_px;
        uint mu = (permeability[at] >> shift) & 15u;
        uint c = ALONG == 0 ? 16u : weight[at];
        a = c + ((a * mu) >> 4);
        weight[at] = a;
    }
    uint back = 0u, mu_after = 0u;
    for (int i = count - 1; i >= 0; --i) {
        int at = first + i * step_px;
        uint mu = (permeability[at] >> shift) & 15u;
        uint before = weight[i > 0 ? at - step_px : at];
        back = (back * mu_after) >> 4;
        weight[at] = (a + back) >> scale;
        back += a - ((before * mu) >> 4);
        mu_after = mu;
        a = before;
    }
}
