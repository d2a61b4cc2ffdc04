// Edge confidence: how reliable the colour of each pixel is, from the distance to the nearest depth edge, since lens and
// sensor mix the colours of both sides of an edge.
#include "tolerances.glsl"
#ifndef REACH
#define REACH 2  // px from a depth edge within which colours are mixed
#endif

uniform sampler2D depth_map;  // metres, 0 = unknown, negative = inpainted; of the picture's size or smaller
uniform ivec2 picture_size;

layout(location = 0) out float confidence;

const float min_confidence = 0.02;  // above 0, so that the colour is used where no rig has a better one

float depth_at(ivec2 at) {
    ivec2 size = textureSize(depth_map, 0);
    ivec2 there = ivec2((vec2(at) + 0.5) * vec2(size) / vec2(picture_size));
    return abs(texelFetch(depth_map, clamp(there, ivec2(0), size - 1), 0).r);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float own = depth_at(at);
    float nearest = float((REACH + 1) * (REACH + 1));
    for (int y = -REACH; y <= REACH; ++y)
        for (int x = -REACH; x <= REACH; ++x) {
            float z = depth_at(at + ivec2(x, y));
            if (max(z, own) > min(z, own) * depth_edge_ratio) nearest = min(nearest, float(x * x + y * y));
        }
    float pure = (sqrt(nearest) - 1.0) / float(REACH);
    confidence = mix(min_confidence, 1.0, pure * pure);
#ifdef WITHOUT_EDGE_CONFIDENCE  // tests/bench/step_worth.py
    confidence = 1.0;
#endif
}
