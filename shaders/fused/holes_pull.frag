// Halves an image with holes: each pixel is the mean of the farther ones of up to four known pixels.
uniform sampler2D colour;   // alpha 0 = hole
uniform sampler2D depth_m;

layout(location = 0) out vec4 half_colour;
layout(location = 1) out float half_depth_m;

void main() {
    ivec2 size = textureSize(colour, 0);
    ivec2 at = 2 * ivec2(gl_FragCoord.xy);
    vec4 c[4];
    float z[4];
    float farthest = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 child = min(at + ivec2(i & 1, i >> 1), size - 1);
        c[i] = texelFetch(colour, child, 0);
        z[i] = c[i].a > 0.0 ? texelFetch(depth_m, child, 0).r : 0.0;
        farthest = max(farthest, z[i]);
    }
    vec4 sum = vec4(0.0);
    float sum_z = 0.0;
    for (int i = 0; i < 4; ++i) {
        float weight = c[i].a > 0.0 && z[i] >= 0.95 * farthest ? 1.0 : 0.0;
        sum += weight * vec4(c[i].rgb, 1.0);
        sum_z += weight * z[i];
    }
    bool any = sum.a > 0.0;
    half_colour = any ? vec4(sum.rgb / sum.a, 1.0) : vec4(0.0);
    half_depth_m = any ? sum_z / sum.a : 0.0;
}
