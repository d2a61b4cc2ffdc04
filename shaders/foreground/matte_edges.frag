// The soft matte: the foreground's share of the pixels at the hard matte's edges. The background's colour is known and a
// pixel farther inside has the foreground's: where the two differ, the pixel's colour determines the share (matting with
// a known background: Smith and Blinn, 1996). Where they do not, the share is what lens and sensor make of a hard edge.
uniform sampler2D hard;        // from matte.frag: 0 or 1
uniform sampler2D picture;     // this instant's
uniform sampler2D background_colour;  // mean of the instants that showed the background

layout(location = 0) out float share;  // the foreground's share of the pixel

const vec2 smooth_edge = vec2(0.2, 0.8);  // filtered shares below and above which a pixel is pure
const vec2 certain = vec2(0.1, 0.9);      // the same for shares by colour
const float inward_px = 2.0;          // from an edge to a pixel of pure foreground
const float min_contrast = 0.08;      // distance of two colours (0..1) from which on they decide
const float off_line_penalty = 2.0;   // for a colour's distance from the line between the two
const float pure_share = 0.99;

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
    if (around(inside) < pure_share) inside *= 0.6;
    if (around(inside) < pure_share) return;
    vec3 behind = textureLod(background_colour, uv, 0.0).rgb;
    vec3 span = textureLod(picture, uv + texel * inside, 0.0).rgb - behind;
    vec3 own = textureLod(picture, uv, 0.0).rgb - behind;
    float apart = dot(span, span);
    float seen = clamp(dot(own, span) / max(apart, 1e-6), 0.0, 1.0);
    // A colour off the line between the two belongs to a third surface.
    float told = smoothstep(0.5 * min_contrast, min_contrast, sqrt(apart) - off_line_penalty * length(own - seen * span));
    share = mix(share, clamp((seen - certain.x) / (certain.y - certain.x), 0.0, 1.0), told);
}
