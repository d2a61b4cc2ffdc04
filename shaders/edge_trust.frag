// How far the colour of every pixel of a rig's picture can be trusted: lens and sensor mix the colours of both sides of
// a depth edge. Copies the colours; alpha is the trust, times what the picture has there.
#ifndef REACH
#define REACH 2  // px from a depth edge to which colours are mixed
#endif

uniform sampler2D picture;
uniform sampler2D depth_map;  // metres, 0 = unknown, negative = guessed; of the picture's size or smaller
uniform float edge_ratio;     // two depths whose ratio is larger lie on two surfaces

layout(location = 0) out vec4 trusted;

const float least_trust = 0.02;  // something is better than nothing
const float least_alpha = 1.0 / 255.0;

float depth_at(ivec2 at, ivec2 picture_size) {
    ivec2 size = textureSize(depth_map, 0);
    ivec2 there = ivec2((vec2(at) + 0.5) * vec2(size) / vec2(picture_size));
    return abs(texelFetch(depth_map, clamp(there, ivec2(0), size - 1), 0).r);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), size = textureSize(picture, 0);
    float own = depth_at(at, size);
    float nearest = float((REACH + 1) * (REACH + 1));
    for (int y = -REACH; y <= REACH; ++y)
        for (int x = -REACH; x <= REACH; ++x) {
            float z = depth_at(at + ivec2(x, y), size);
            if (max(z, own) > min(z, own) * edge_ratio) nearest = min(nearest, float(x * x + y * y));
        }
    float pure = (sqrt(nearest) - 1.0) / float(REACH);
    vec4 own_colour = texelFetch(picture, at, 0);
    trusted = vec4(own_colour.rgb, max(own_colour.a * mix(least_trust, 1.0, pure * pure), own_colour.a > 0.0 ? least_alpha : 0.0));
}
