// Depth for holes inside a matte that are wider than the neighbourhood of foreground_depth.frag. Each block of pixels
// takes the nearest or the farthest depth on a ring around it at which another rig sees foreground too. Without such a
// rig it takes the mean of the closest ring with depth, unless another rig sees its background there.
#include "other_silhouettes.glsl"
#include "foreground_blocks.glsl"

uniform sampler2D depth_map;  // metres, 0 = unknown
uniform sampler2D matte;      // the foreground's share of each pixel

layout(location = 0) out float far_m;  // metres, 0 = none

const int ring_taps = 8;
const ivec2 ring[ring_taps] = ivec2[](
    ivec2(2, 4), ivec2(-2, 4), ivec2(-4, 2), ivec2(-4, -2), ivec2(-2, -4), ivec2(2, -4), ivec2(4, -2), ivec2(4, 2));
const int max_scale = 32;  // of the ring
const float none = 1e9;

bool is_confirmed(ivec2 at, float z) { return z > 0.0 && z < none && look_at_silhouettes(vec2(at), z) > 0; }

void main() {
    ivec2 size = textureSize(depth_map, 0), at = block_px * ivec2(gl_FragCoord.xy) + block_px / 2;
    bool is_foreground = textureLod(matte, (vec2(at) + 0.5) / vec2(size), 0.0).r > 0.0;
    far_m = 0.0;
    float unconfirmed = 0.0;
    for (int scale = 1; scale <= max_scale && is_foreground && far_m == 0.0; scale *= 2) {
        float nearest = none, farthest = 0.0, sum = 0.0, count = 0.0;
        for (int k = 0; k < ring_taps; ++k) {
            float z = texelFetch(depth_map, clamp(at + scale * ring[k], ivec2(0), size - 1), 0).r;
            if (z > 0.0) nearest = min(nearest, z);
            farthest = max(farthest, z);
            if (z > 0.0) sum += 1.0 / z, count += 1.0;
        }
        far_m = is_confirmed(at, nearest) ? nearest : is_confirmed(at, farthest) ? farthest : 0.0;
        if (unconfirmed == 0.0 && count > 0.0 && look_at_silhouettes(vec2(at), count / sum) >= 0) unconfirmed = count / sum;
    }
    if (is_foreground && far_m == 0.0) far_m = unconfirmed;
}
