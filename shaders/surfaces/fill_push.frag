// Keeps known pixels and fills holes from the image of half the size.
#ifndef COLOUR
#define COLOUR 0  // 1: a colour image; 0: a depth map
#endif
uniform sampler2D coarse;
#if COLOUR
uniform sampler2D known;  // alpha 0 = hole
uniform float filled_alpha;

layout(location = 0) out vec4 filled;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 here = texelFetch(known, at, 0);
    if (here.a > 0.0) {
        filled = here;
        return;
    }
    vec4 there = textureLod(coarse, (0.5 * vec2(at) + 0.25) / vec2(textureSize(coarse, 0)), 0.0);
    filled = vec4(there.rgb, there.a > 0.5 ? filled_alpha : 0.0);
}
#else
uniform sampler2D known;  // metres, 0 = unknown, negative = inpainted, as is all that is filled

layout(location = 0) out float filled;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float z = texelFetch(known, at, 0).r;
    if (z != 0.0) {
        filled = z;
        return;
    }
    ivec2 size = textureSize(coarse, 0);
    // The four coarse pixels around this one, weighted as in bilinear interpolation.
    ivec2 low = (at + 1) / 2 - 1;
    vec2 part = vec2(at & 1) * -0.5 + 0.75;
    float sum = 0.0, weights = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 corner = ivec2(i & 1, i >> 1);
        float there = abs(texelFetch(coarse, clamp(low + corner, ivec2(0), size - 1), 0).r);
        vec2 w = mix(1.0 - part, part, vec2(corner));
        if (there > 0.0) {
            sum += w.x * w.y / there;
            weights += w.x * w.y;
        }
    }
    filled = weights > 0.0 ? -weights / sum : 0.0;
}
#endif
