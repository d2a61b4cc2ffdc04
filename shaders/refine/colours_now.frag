// The colours of a rig's set at this instant, behind its performers too. Alpha says how far they count: beside depth
// edges less, and what is only remembered hardly does.
#include "background_kinds.glsl"

uniform sampler2D picture;
uniform sampler2D seen;        // from background_compare.frag
uniform sampler2D matte;       // the performers' share
uniform sampler2D background_colour;  // from background_colour.frag: alpha is 1 where the set is seen now
uniform sampler2D performers;  // their depth, metres, 0 = none there nor beside
uniform sampler2D background_depth;   // from background_show.frag, metres, negative = guessed
uniform sampler2D confidence;       // from edge_confidence.frag
uniform float remembered;      // alpha of what is

const float before = 0.97;  // share of the set's depth: what is farther than that does not stand before it
const float least_alpha = 1.0 / 255.0;  // something is better than nothing

layout(location = 0) out vec4 colour;

vec4 colour_now(ivec2 at) {
    vec4 set = texelFetch(background_colour, at, 0);
    if (set.a == 1.0) return set;
    vec2 uv = gl_FragCoord.xy / vec2(textureSize(picture, 0));
    // Beside a performer, too, what is neither of the set nor of the performer is not what was there before.
    float share = texelFetch(matte, at, 0).r;
    bool is_third = share == 0.0 && is_kind(textureLod(seen, uv, 0.0).r, untold);
    float performer_m = abs(textureLod(performers, uv, 0.0).r);
    bool stands_before = performer_m > 0.0 && performer_m < before * abs(textureLod(background_depth, uv, 0.0).r);
    bool is_now = is_third || !stands_before;
    return is_now ? vec4(texelFetch(picture, at, 0).rgb, 1.0) : vec4(set.rgb, share < 0.5 ? set.a : remembered);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    colour = colour_now(at);
    if (colour.a > 0.0) colour.a = max(colour.a * texelFetch(confidence, at, 0).r, least_alpha);
}
