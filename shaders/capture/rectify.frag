// Resamples a raw picture into its rectified form, bilinearly, in whole numbers: positions are rounded to 1/256 px, so
// that weights and sums stay below 2^24 and are exact in float, on every GPU and in the CPU reference alike. Outside of
// the raw picture everything is black. The result is opaque, as every raw picture is.
#ifndef PACKED
#define PACKED 0  // 1: positions come as packed_positions.h has them
#endif
#ifndef PLANES
#define PLANES 0  // 1: the raw picture is a camera's buffer of FORMAT. YUV is resampled first and converted then.
#endif
uniform sampler2D raw;  // rgba8; with PLANES the first plane, see camera_picture.frag
#if PACKED
uniform highp usampler2D positions;  // r32ui, of the target's size
#else
uniform sampler2D positions;  // rg32f, of the target's size: (x, y) in the raw picture, px
#endif
layout(location = 0) out vec4 rectified;

// A level of 0..1 as a whole number of 0..255: some GPUs deliver texels as half floats.
#define WHOLE(level) roundEven((level) * 255.0)

// The whole number between four levels, those of the upper row first.
#define LEVELS_BETWEEN(V, a, b, c, d, fraction, result)                                               \
    {                                                                                                 \
        V upper_left = WHOLE(a), lower_left = WHOLE(c);                                               \
        V upper = upper_left * 256.0 + (WHOLE(b) - upper_left) * (fraction).x;                        \
        V lower = lower_left * 256.0 + (WHOLE(d) - lower_left) * (fraction).x;                        \
        V sum = upper * 256.0 + (lower - upper) * (fraction).y;                                       \
        result = floor((sum + 32768.0) * (1.0 / 65536.0));                                            \
    }

#if PLANES
#include "camera_formats.glsl"
uniform sampler2D chroma;
uniform ivec2 raw_size;       // of the part of the buffer that is the picture
uniform vec2 raw_texel, chroma_texel;  // one texel of the planes, of their size
uniform int first_column_px;  // of that part

// Y, U and V of a pixel, 0..1; grey formats have Y alone.
vec3 texel(ivec2 at) {
    at.x += first_column_px;
#if FORMAT == 0
    return texelFetch(raw, at, 0).rrr;
#elif FORMAT == 1
    ivec2 bytes = ivec2(texelFetch(raw, at, 0).rg * 255.0 + 0.5);
    return vec3(float(min((bytes.r | bytes.g << 8) >> 2, 255)) * (1.0 / 255.0));
#elif FORMAT == 2
    return texelFetch(raw, at, 0).ggg;
#elif FORMAT == 3
    vec4 pair = texelFetch(raw, ivec2(at.x >> 1, at.y), 0);
    return vec3((at.x & 1) == 0 ? pair.r : pair.b, pair.ga);
#else
    return vec3(texelFetch(raw, at, 0).r, texelFetch(chroma, at >> 1, 0).rg);
#endif
}
const vec3 black = vec3(FORMAT >= 3 ? 16.0 / 255.0 : 0.0, vec2(128.0 / 255.0));

// The levels of a pixel whose four raw pixels are all inside. A gather gives the lower left, lower right, upper right and
// upper left of four texels.
#define GATHERED(four, fraction, result) LEVELS_BETWEEN(float, four.w, four.z, four.x, four.y, fraction, result)
vec3 levels_inside(ivec2 at, vec2 fraction) {
    at.x += first_column_px;
    vec3 levels = vec3(0.0);
#if FORMAT == 0 || FORMAT == 2
    vec4 y = textureGather(raw, vec2(at + 1) * raw_texel, FORMAT == 0 ? 0 : 1);
    GATHERED(y, fraction, levels.x)
#elif FORMAT == 1
    vec2 corner = vec2(at + 1) * raw_texel;
    ivec4 low = ivec4(textureGather(raw, corner, 0) * 255.0 + 0.5), high = ivec4(textureGather(raw, corner, 1) * 255.0 + 0.5);
    vec4 y = vec4(min((low | (high << 8)) >> 2, ivec4(255))) * (1.0 / 255.0);
    GATHERED(y, fraction, levels.x)
#elif FORMAT == 3
    vec2 corner = vec2((at.x >> 1) + 1, at.y + 1) * raw_texel;
    vec4 even = textureGather(raw, corner, 0), odd = textureGather(raw, corner, 2);
    vec4 u = textureGather(raw, corner, 1), v = textureGather(raw, corner, 3);
    // Two pixels of one texel, or the second one of it and the first one of the next.
    bool is_odd = (at.x & 1) != 0;
    vec4 y = is_odd ? vec4(odd.x, even.y, even.z, odd.w) : vec4(even.x, odd.x, odd.w, even.w);
    // Pixels of one texel share its chroma.
    vec2 chroma_fraction = vec2(is_odd ? fraction.x : 0.0, fraction.y);
    GATHERED(y, fraction, levels.x)
    GATHERED(u, chroma_fraction, levels.y)
    GATHERED(v, chroma_fraction, levels.z)
#else
    vec4 y = textureGather(raw, vec2(at + 1) * raw_texel, 0);
    ivec2 chroma_at = at >> 1;
    vec2 chroma_corner = vec2(chroma_at + 1) * chroma_texel;
    vec4 u = textureGather(chroma, chroma_corner, 0), v = textureGather(chroma, chroma_corner, 1);
    // Pixels of one texel share its chroma.
    vec2 chroma_fraction = fraction * vec2(at & 1);
    GATHERED(y, fraction, levels.x)
    GATHERED(u, chroma_fraction, levels.y)
    GATHERED(v, chroma_fraction, levels.z)
#endif
    return levels;
}

vec3 rgb_of(vec3 levels) {
#if FORMAT >= 3
    // BT.601 of limited range in 1/8192, which floats hold exactly; the target clamps.
    vec3 sums = levels.x * vec3(9539.0) + levels.y * vec3(0.0, -3209.0, 16525.0) + levels.z * vec3(13075.0, -6660.0, 0.0);
    return floor((sums + vec3(-1822128.0, 1114704.0, -2263728.0)) * (1.0 / 8192.0));
#else
    return levels.xxx;
#endif
}
#else
vec3 texel(ivec2 at) { return texelFetch(raw, at, 0).rgb; }
const vec3 black = vec3(0.0);
vec3 levels_inside(ivec2 at, vec2 fraction) {
    vec3 a = texel(at), b = texel(at + ivec2(1, 0)), c = texel(at + ivec2(0, 1)), d = texel(at + ivec2(1, 1)), levels;
    LEVELS_BETWEEN(vec3, a, b, c, d, fraction, levels)
    return levels;
}
vec3 rgb_of(vec3 levels) { return levels; }
#endif

vec3 texel_or_black(ivec2 at, ivec2 last) {
    ivec2 inside = clamp(at, ivec2(0), last);
    return at == inside ? texel(inside) : black;
}

void main() {
#if PLANES
    ivec2 size = raw_size;
#else
    ivec2 size = textureSize(raw, 0);
#endif
    ivec2 last = size - 1;
#if PACKED
    uint word = texelFetch(positions, ivec2(gl_FragCoord.xy), 0).r;
    ivec2 steps = ivec2(word & 0xffffu, word >> 16) - 32768 + 256 * ivec2(gl_FragCoord.xy);
    bool touches = word != 0u;
    ivec2 at = steps >> 8;
    vec2 fraction = vec2(steps & 255);
#else
    vec2 position = texelFetch(positions, ivec2(gl_FragCoord.xy), 0).xy;
    vec2 steps = floor(position * 256.0 + 0.5);
    // Comparisons of floats: a position that is not a number fails them and counts as outside.
    bool touches = all(greaterThan(position, vec2(-1.0))) && all(lessThan(position, vec2(size)));
    vec2 corner = floor(steps * (1.0 / 256.0));
    vec2 fraction = steps - corner * 256.0;
    ivec2 at = ivec2(corner);
#endif
    vec3 levels;
    if (touches && all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, last))) {
        // The usual case, all four texels inside, needs no more tests.
        levels = levels_inside(at, fraction);
    } else {
        if (!touches) {
            rectified = vec4(0.0, 0.0, 0.0, 1.0);
            return;
        }
        vec3 a = texel_or_black(at, last), b = texel_or_black(at + ivec2(1, 0), last);
        vec3 c = texel_or_black(at + ivec2(0, 1), last), d = texel_or_black(at + ivec2(1, 1), last);
        LEVELS_BETWEEN(vec3, a, b, c, d, fraction, levels)
    }
    rectified = vec4(rgb_of(levels) * (1.0 / 255.0), 1.0);
}
