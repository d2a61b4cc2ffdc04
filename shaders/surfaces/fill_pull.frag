// Halves an image with holes: each pixel is the mean of the farther ones among the known pixels of a window.
#ifndef COLOUR
#define COLOUR 0  // 1: a colour image with its depth; 0: a depth map
#endif
uniform sampler2D depth_map;  // metres, 0 = unknown, negative = inpainted
#if COLOUR
uniform sampler2D image;  // alpha 0 = hole

layout(location = 0) out vec4 half_colour;
layout(location = 1) out float half_depth;

// Pixels that the window reaches past the four that become one.
const int reach = 0;
#else
layout(location = 0) out float half_depth;

// Reaches past the four, so that the far side of a hole prevails.
const int reach = 1;
#endif
const int side = 2 + 2 * reach;
// Pixels that are nearer than this share of the farthest are left out.
const float far_share = 0.95;

void main() {
    ivec2 last = textureSize(depth_map, 0) - 1;
    ivec2 at = 2 * ivec2(gl_FragCoord.xy) - reach;
    float z[side * side];
    float farthest = 0.0;
#if COLOUR
    vec4 c[side * side];
#endif
    for (int i = 0; i < side * side; ++i) {
        ivec2 child = clamp(at + ivec2(i % side, i / side), ivec2(0), last);
        z[i] = texelFetch(depth_map, child, 0).r;
#if COLOUR
        c[i] = texelFetch(image, child, 0);
        if (c[i].a == 0.0) z[i] = 0.0;
#endif
        farthest = max(farthest, z[i]);
    }
#if COLOUR
    vec4 sum = vec4(0.0);
    float sum_z = 0.0;
    for (int i = 0; i < side * side; ++i) {
        float weight = c[i].a > 0.0 && z[i] >= far_share * farthest ? 1.0 : 0.0;
        sum += weight * vec4(c[i].rgb, 1.0);
        sum_z += weight * z[i];
    }
    bool any = sum.a > 0.0;
    half_colour = any ? vec4(sum.rgb / sum.a, 1.0) : vec4(0.0);
    half_depth = any ? sum_z / sum.a : 0.0;
#else
    float count = 0.0, sum = 0.0;
    for (int i = 0; i < side * side; ++i)
        if (z[i] > 0.0 && z[i] >= far_share * farthest) {
            count += 1.0;
            sum += 1.0 / z[i];
        }
    half_depth = count > 0.0 ? count / sum : 0.0;
#endif
}
