// What of a rig's picture is its performers': their share of each pixel, and their colour times that. What a rig has learnt
// of its set behind them is taken away from the pixels that show both; what is left is between such a pixel's colour and
// that of the neighbour which is a performer's most, for shares of a few per cent tell of no colour.
uniform sampler2D picture;
uniform sampler2D background_colour;
uniform sampler2D matte;  // the performers' share

layout(location = 0) out vec4 performers;

const float beside_px = 1.5;
const float noise = 0.03;  // of colours (0..1)

void main() {
    vec2 texel = 1.0 / vec2(textureSize(picture, 0)), uv = gl_FragCoord.xy * texel;
    float share = textureLod(matte, uv, 0.0).r;
    vec3 own = textureLod(picture, uv, 0.0).rgb;
    performers = vec4(share * own, share);
    if (share == 0.0 || share == 1.0) return;
    vec2 inside = uv;
    float most = share;
    for (int k = 0; k < 4; ++k) {
        vec2 there = uv + beside_px * texel * (2.0 * vec2(k & 1, k >> 1) - 1.0);
        float its = textureLod(matte, there, 0.0).r;
        if (its > most) most = its, inside = there;
    }
    vec3 body = textureLod(picture, inside, 0.0).rgb;
    vec3 apart = (own - (1.0 - share) * textureLod(background_colour, uv, 0.0).rgb) / share;
    performers.rgb = share * clamp(apart, max(min(own, body) - noise, 0.0), min(max(own, body) + noise, 1.0));
}
