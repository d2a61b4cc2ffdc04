// The edges of a matte as lens and sensor see them, and the performers' own colour there, without the set's share.
uniform sampler2D picture;     // this instant's
uniform sampler2D set_colour;  // mean of the instants that showed the set
uniform sampler2D hard;        // from matte.frag: alpha is 0 or 1

layout(location = 0) out vec4 performer;  // alpha: the share

const vec2 certain = vec2(0.1, 0.9);  // shares below and above which a pixel is all of one
const float least_unmixed = 0.3;       // share from which on a colour can be told from a mixture

void main() {
    vec2 texel = 1.0 / vec2(textureSize(picture, 0)), uv = gl_FragCoord.xy * texel;
    vec3 now = textureLod(picture, uv, 0.0).rgb;
    // Four linear samples: a binomial filter of three by three.
    float share = 0.0;
    for (int k = 0; k < 4; ++k)
        share += 0.25 * textureLod(hard, uv + texel * (vec2(k & 1, k >> 1) - 0.5), 0.0).a;
    share = clamp((share - certain.x) / (certain.y - certain.x), 0.0, 1.0);
    performer = vec4(now, share);
    if (share == 0.0 || share == 1.0) return;
    float own = max(share, least_unmixed);
    performer.rgb = clamp((now - (1.0 - own) * textureLod(set_colour, uv, 0.0).rgb) / own, 0.0, 1.0);
}
