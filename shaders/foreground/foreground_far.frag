// Depth for what is missing within a matte, farther from all that was measured than foreground_depth.frag looks: for a
// block of pixels, that of a ring's nearest or farthest at which another rig sees a performer too.
#include "other_silhouettes.glsl"
#include "foreground_blocks.glsl"

uniform sampler2D depth_map;  // metres, 0 = unknown
uniform sampler2D matte;      // the performers' share

layout(location = 0) out float far_m;  // metres, 0 = none

const int ring_taps = 8;
const ivec2 ring[ring_taps] = ivec2[](
    ivec2(2, 4), ivec2(-2, 4), ivec2(-4, 2), ivec2(-4, -2), ivec2(-2, -4), ivec2(2, -4), ivec2(4, -2), ivec2(4, 2));
const int most_scale = 8;  // of that ring
const float none = 1e9;

bool is_told(ivec2 at, float z) { return z > 0.0 && z < none && look_at_silhouettes(vec2(at), z) > 0; }

void main() {
    ivec2 size = textureSize(depth_map, 0), at = block_px * ivec2(gl_FragCoord.xy) + block_px / 2;
    bool is_foreground = textureLod(matte, (vec2(at) + 0.5) / vec2(size), 0.0).r > 0.0;
    far_m = 0.0;
    for (int scale = 1; scale <= most_scale && is_foreground && far_m == 0.0; scale *= 2) {
        float nearest = none, farthest = 0.0;
        for (int k = 0; k < ring_taps; ++k) {
            float z = texelFetch(depth_map, clamp(at + scale * ring[k], ivec2(0), size - 1), 0).r;
            if (z > 0.0) nearest = min(nearest, z);
            farthest = max(farthest, z);
        }
        far_m = is_told(at, nearest) ? nearest : is_told(at, farthest) ? farthest : 0.0;
    }
}
