// What lens and sensor make of 2 x 2 samples a pixel: each pixel sees the 6 x 6 samples around its
// middle through a Gaussian point spread. A linear filter fetches two samples a side at once: the
// middle two weigh alike, the outer two meet at their common centre.
#ifndef POINT_SPREAD_PX
#define POINT_SPREAD_PX 0.65
#endif
uniform sampler2D samples;

layout(location = 0) out vec4 colour;

float spread(float offset_px) {
    return exp(-0.5 * offset_px * offset_px / (POINT_SPREAD_PX * POINT_SPREAD_PX));
}

void main() {
    float near = spread(0.25), far = spread(0.75), farthest = spread(1.25);
    float outer = far + farthest;
    vec3 weights = vec3(outer, 2.0 * near, outer) / (2.0 * (near + outer));
    float reach_px = (0.75 * far + 1.25 * farthest) / outer;
    vec2 per_px = 2.0 / vec2(textureSize(samples, 0));
    vec4 sum = vec4(0.0);
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
            sum += weights[x + 1] * weights[y + 1] *
                   texture(samples, (gl_FragCoord.xy + reach_px * vec2(x, y)) * per_px);
    colour = sum;
}
