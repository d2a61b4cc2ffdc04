// The colours of a rig's background at this instant, behind its foreground too. Alpha is their confidence: lower beside
// depth edges, and lowest where the colour is remembered since foreground hides it.
#include "background_kinds.glsl"
#include "sharpened.glsl"

uniform sampler2D picture;
uniform sampler2D seen;        // from background_compare.frag
uniform sampler2D matte;       // the foreground's share
uniform sampler2D background_colour;  // from background_colour.frag: alpha is 1 where the background is visible now
uniform sampler2D performers;  // depth of the foreground, metres, 0 = none there nor beside
uniform sampler2D background_depth;   // from background_show.frag, metres, negative = inpainted
uniform sampler2D confidence;       // from edge_confidence.frag
uniform float remembered;      // alpha of a remembered colour

const float before = 0.97;  // share of the background's depth up to which the foreground stands before it
const float min_alpha = 1.0 / 255.0;  // above 0, so that the colour is used where no rig has a better one

layout(location = 0) out vec4 colour;

vec4 colour_now(ivec2 at) {
    vec4 known = texelFetch(background_colour, at, 0);
    if (known.a == 1.0) return vec4(sharpened(background_colour, at), 1.0);
    vec2 uv = gl_FragCoord.xy / vec2(textureSize(picture, 0));
    // A pixel beside the foreground may show neither the foreground nor the remembered background.
    float share = texelFetch(matte, at, 0).r;
    bool is_neither = share == 0.0 && is_kind(textureLod(seen, uv, 0.0).r, undecided);
    float performer_m = abs(textureLod(performers, uv, 0.0).r);
    bool stands_before = performer_m > 0.0 && performer_m < before * abs(textureLod(background_depth, uv, 0.0).r);
    bool is_now = is_neither || !stands_before;
    return is_now ? vec4(sharpened(picture, at), 1.0) : vec4(known.rgb, share < 0.5 ? known.a : remembered);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    colour = colour_now(at);
    if (colour.a > 0.0) colour.a = max(colour.a * texelFetch(confidence, at, 0).r, min_alpha);
}
