// Resamples a raw picture into its rectified form, bilinearly, in whole numbers: positions are
// rounded to 1/256 px, so that weights and sums stay below 2^24 and are exact in float, on every
// GPU and in the CPU reference alike. Outside of the raw picture everything is opaque black.
uniform sampler2D raw;       // rgba8
uniform sampler2D positions; // rg32f, of the target's size: (x, y) in the raw picture, px
layout(location = 0) out vec4 rectified;

const vec4 outside = vec4(0.0, 0.0, 0.0, 255.0);

vec4 raw_at(ivec2 at, ivec2 last) {
    bool inside = at == clamp(at, ivec2(0), last);
    return inside ? floor(texelFetch(raw, clamp(at, ivec2(0), last), 0) * 255.0 + 0.5) : outside;
}

void main() {
    vec2 position = texelFetch(positions, ivec2(gl_FragCoord.xy), 0).xy;
    ivec2 size = textureSize(raw, 0);
    // Written so that a position that is no number counts as outside.
    bool touches = all(greaterThan(position, vec2(-1.0))) && all(lessThan(position, vec2(size)));
    if (!touches) {
        rectified = outside / 255.0;
        return;
    }
    vec2 steps = floor(position * 256.0 + 0.5);
    vec2 corner = floor(steps / 256.0);
    vec2 fraction = steps - corner * 256.0;
    ivec2 at = ivec2(corner);
    ivec2 last = size - 1;
    vec4 upper = raw_at(at, last) * (256.0 - fraction.x) + raw_at(at + ivec2(1, 0), last) * fraction.x;
    vec4 lower = raw_at(at + ivec2(0, 1), last) * (256.0 - fraction.x) +
                 raw_at(at + ivec2(1, 1), last) * fraction.x;
    vec4 sum = upper * (256.0 - fraction.y) + lower * fraction.y;
    rectified = floor((sum + 32768.0) / 65536.0) / 255.0;
}
