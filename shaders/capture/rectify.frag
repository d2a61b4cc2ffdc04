// Resamples a raw picture into its rectified form, bilinearly, in whole numbers: positions are
// rounded to 1/256 px, so that weights and sums stay below 2^24 and are exact in float, on every
// GPU and in the CPU reference alike. Outside of the raw picture everything is black. The result
// is opaque, as every raw picture is.
#ifndef PACKED
#define PACKED 0 // 1: positions come as packed_positions.h has them
#endif
uniform sampler2D raw; // rgba8
#if PACKED
uniform highp usampler2D positions; // r32ui, of the target's size
#else
uniform sampler2D positions; // rg32f, of the target's size: (x, y) in the raw picture, px
#endif
layout(location = 0) out vec4 rectified;

vec3 texel(ivec2 at) { return floor(texelFetch(raw, at, 0).rgb * 255.0 + 0.5); }
vec3 texel_or_black(ivec2 at, ivec2 last) {
    ivec2 inside = clamp(at, ivec2(0), last);
    return at == inside ? texel(inside) : vec3(0.0);
}

void main() {
    ivec2 size = textureSize(raw, 0);
    ivec2 last = size - 1;
#if PACKED
    uint word = texelFetch(positions, ivec2(gl_FragCoord.xy), 0).r;
    vec2 steps = vec2(ivec2(word & 0xffffu, word >> 16) - 32768 + 256 * ivec2(gl_FragCoord.xy));
    bool touches = word != 0u;
#else
    vec2 position = texelFetch(positions, ivec2(gl_FragCoord.xy), 0).xy;
    vec2 steps = floor(position * 256.0 + 0.5);
    // Comparisons of floats: a position that is not a number fails them and counts as outside.
    bool touches = all(greaterThan(position, vec2(-1.0))) && all(lessThan(position, vec2(size)));
#endif
    vec2 corner = floor(steps * (1.0 / 256.0));
    vec2 fraction = steps - corner * 256.0;
    ivec2 at = ivec2(corner);
    vec3 a, b, c, d;
    if (touches && all(greaterThanEqual(corner, vec2(0.0))) && all(lessThan(corner, vec2(last)))) {
        // The usual case, all four texels inside, needs no more tests.
        a = texel(at), b = texel(at + ivec2(1, 0)), c = texel(at + ivec2(0, 1)), d = texel(at + ivec2(1, 1));
    } else {
        if (!touches) {
            rectified = vec4(0.0, 0.0, 0.0, 1.0);
            return;
        }
        a = texel_or_black(at, last), b = texel_or_black(at + ivec2(1, 0), last);
        c = texel_or_black(at + ivec2(0, 1), last), d = texel_or_black(at + ivec2(1, 1), last);
    }
    vec3 upper = a * 256.0 + (b - a) * fraction.x, lower = c * 256.0 + (d - c) * fraction.x;
    vec3 sum = upper * 256.0 + (lower - upper) * fraction.y;
    rectified = vec4(floor((sum + 32768.0) * (1.0 / 65536.0)) / 255.0, 1.0);
}
