// The foreground of a rig's image: its share of each pixel, and its colour premultiplied by that share. The learnt
// background colour is subtracted from pixels that show both. The result is clamped between the pixel's colour and that
// of the neighbour with the largest share, because a share of a few per cent does not determine a colour.
#include "sharpened.glsl"

uniform sampler2D picture;
uniform sampler2D background_colour;
uniform sampler2D matte;  // the foreground's share of each pixel

layout(location = 0) out vec4 performers;

const float beside_px = 1.5;  // to the neighbours that are compared
const float noise = 0.03;  // of the camera's colours (0..1)

void main() {
    vec2 texel = 1.0 / vec2(textureSize(picture, 0)), uv = gl_FragCoord.xy * texel;
    float share = textureLod(matte, uv, 0.0).r;
    if (share == 1.0) {
        performers = vec4(sharpened(picture, ivec2(gl_FragCoord.xy)), 1.0);
        return;
    }
    vec3 own = textureLod(picture, uv, 0.0).rgb;
    performers = vec4(share * own, share);
    if (share == 0.0) return;
#ifdef WITHOUT_UNMIXING  // tests/bench/step_worth.py
    return;
#endif
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
