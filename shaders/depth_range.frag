// The nearest and the farthest depth around every pixel: where they lie apart, an edge is close.
#ifndef RADIUS
#define RADIUS 2
#endif
uniform sampler2D depth_map;  // metres, 0 = unknown, negative = guessed

layout(location = 0) out vec2 near_far;

void main() {
    ivec2 size = textureSize(depth_map, 0);
    ivec2 at = ivec2(gl_FragCoord.xy);
    float least = 1e30, most = 0.0;
    for (int y = -RADIUS; y <= RADIUS; ++y)
        for (int x = -RADIUS; x <= RADIUS; ++x) {
            float z = abs(texelFetch(depth_map, clamp(at + ivec2(x, y), ivec2(0), size - 1), 0).r);
            if (z > 0.0) {
                least = min(least, z);
                most = max(most, z);
            }
        }
    near_far = most > 0.0 ? vec2(least, most) : vec2(0.0);
}
