// A matte with the share that performers have of the pixels at its edges. What stands behind them is known there, and a
// pixel farther in shows their colour: where those two differ, the pixel's colour says how much it shows of either
// (a matte with a known background: Smith and Blinn, 1996). Where they do not, the share that lens and sensor make of a
// hard edge.
uniform sampler2D hard;        // from matte.frag: 0 or 1
uniform sampler2D picture;     // this instant's
uniform sampler2D background_colour;  // mean of the instants that showed the set

layout(location = 0) out float share;  // of the pixel, that is before the set

const vec2 smooth_edge = vec2(0.2, 0.8);  // shares around below and above which a pixel is all of one
const vec2 certain = vec2(0.1, 0.9);      // likewise, of colours
const float inward_px = 2.0;          // from an edge to what is all performer
const float told_from = 0.08;         // distance of two colours (0..1) from which on they tell
const float third = 2.0;              // how much less they tell for what a colour is off their line
const float whole = 0.99;

vec2 texel, uv;

float around(vec2 aside_px) { return textureLod(hard, uv + texel * aside_px, 0.0).r; }

void main() {
    texel = 1.0 / vec2(textureSize(hard, 0));
    uv = gl_FragCoord.xy * texel;
    // Four linear samples: a binomial filter of three by three; four more, farther out.
    float geometric = 0.0;
    vec4 corner;
    for (int k = 0; k < 4; ++k) {
        vec2 to = vec2(k & 1, k >> 1) - 0.5;
        geometric += 0.25 * around(to);
        corner[k] = around(3.0 * to);
    }
    float all = dot(corner, vec4(0.25));
    share = smoothstep(smooth_edge.x, smooth_edge.y, mix(geometric, all, 0.4));
    if ((all == 0.0 && geometric == 0.0) || (all == 1.0 && geometric == 1.0)) return;
    vec2 inward = vec2(corner.y + corner.w - corner.x - corner.z, corner.z + corner.w - corner.x - corner.y);
    if (dot(inward, inward) == 0.0) return;
    vec2 inside = inward_px * inward * inversesqrt(dot(inward, inward));
    if (around(inside) < whole) inside *= 0.6;
    if (around(inside) < whole) return;
    vec3 behind = textureLod(background_colour, uv, 0.0).rgb;
    vec3 span = textureLod(picture, uv + texel * inside, 0.0).rgb - behind;
    vec3 own = textureLod(picture, uv, 0.0).rgb - behind;
    float apart = dot(span, span);
    float seen = clamp(dot(own, span) / max(apart, 1e-6), 0.0, 1.0);
    // What is neither of the two colours, nor between them, is of a third one.
    float told = smoothstep(0.5 * told_from, told_from, sqrt(apart) - third * length(own - seen * span));
    share = mix(share, clamp((seen - certain.x) / (certain.y - certain.x), 0.0, 1.0), told);
}
