// The edges of a matte as lens and sensor see them.
uniform sampler2D hard;  // from matte.frag: 0 or 1

layout(location = 0) out float share;  // of the pixel, that is before the set

const vec2 certain = vec2(0.1, 0.9);  // shares below and above which a pixel is all of one

void main() {
    vec2 texel = 1.0 / vec2(textureSize(hard, 0)), uv = gl_FragCoord.xy * texel;
    // Four linear samples: a binomial filter of three by three.
    share = 0.0;
    for (int k = 0; k < 4; ++k) share += 0.25 * textureLod(hard, uv + texel * (vec2(k & 1, k >> 1) - 0.5), 0.0).r;
    share = clamp((share - certain.x) / (certain.y - certain.x), 0.0, 1.0);
}
