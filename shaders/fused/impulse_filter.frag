// Removes single wrong pixels: a pixel at a depth edge that is brighter or darker in any channel than all but one of its
// eight neighbours, by more than a tolerance, becomes the median of the nine.
#define MEDIAN_OF vec3
#include "stereo_median9.glsl"
#include "two_stages.glsl"

uniform sampler2D picture;
uniform sampler2D depth_m;  // its magnitude counts; 0 = nothing
uniform float edge_ratio;   // two depths whose ratio is larger lie on two surfaces
uniform float tolerance;    // of colours 0..1

layout(location = 0) out vec4 filtered;

vec3 around[9];

// Two by two pixels at a time, whose corners meet in this one: nine pixels in four fetches.
bool is_one_surface(ivec2 at) {
    vec2 texel = 1.0 / vec2(textureSize(depth_m, 0));
    float near = 1e9, far = 0.0;
    for (int k = 0; k < 4; ++k) {
        vec4 z = abs(textureGather(depth_m, vec2(at + ivec2(k & 1, k >> 1)) * texel));
        near = min(near, min(min(z.x, z.y), min(z.z, z.w)));
        far = max(far, max(max(z.x, z.y), max(z.z, z.w)));
    }
    return far <= near * edge_ratio;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), most = textureSize(picture, 0) - 1;
    filtered = texelFetch(picture, at, 0);
#if FIRST
#ifdef WITHOUT_IMPULSE_FILTER  // tests/bench/step_worth.py
    leave_to_second(false);
#else
    leave_to_second(!is_one_surface(at));
#endif
#else
    // The least and the greatest two of the neighbours.
    vec3 low = vec3(1.0), next_low = vec3(1.0), high = vec3(0.0), next_high = vec3(0.0);
    for (int k = 0; k < 9; ++k) {
        vec3 c = texelFetch(picture, clamp(at + ivec2(k % 3, k / 3) - 1, ivec2(0), most), 0).rgb;
        around[k] = c;
        if (k == 4) continue;
        next_low = min(next_low, max(low, c));
        low = min(low, c);
        next_high = max(next_high, min(high, c));
        high = max(high, c);
    }
    if (all(lessThanEqual(filtered.rgb, next_high + tolerance)) &&
        all(greaterThanEqual(filtered.rgb, next_low - tolerance)))
        return;
    filtered.rgb = median9(around[0], around[1], around[2], around[3], around[4], around[5], around[6], around[7],
                           around[8]);
#endif
}
