// The hard matte: which pixels show the foreground. Pixels whose own comparison with the background is undecided follow
// the neighbours of similar colour. Drawn only in tiles that may have foreground (see matte_tiles.frag).
#include "background_kinds.glsl"

uniform sampler2D picture;  // this instant's image
uniform sampler2D seen;     // from background_compare.frag

layout(location = 0) out float performer;  // 0 or 1

const int reach = 2;              // steps to either side
const int step_px = 2;            // from one step to the next, px of the image
const float like_colour = 0.05;   // difference (0..1) at which a pixel's word counts 1/e
const float like_background_here = 0.04; // difference below which those around decide
const float least_around = 0.15;  // share of foreground around a pixel that is taken for foreground
const float most_around = 0.8;    // share from which on a pixel that looks like the background is taken for it
const float new_around = 0.4;     // share for one that looks like a background which has just changed

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), size = textureSize(picture, 0);
    vec2 texel = 1.0 / vec2(size), uv = gl_FragCoord.xy * texel;
    vec3 now = texelFetch(picture, at, 0).rgb;
    performer = 0.0;
    vec3 seen_here = textureLod(seen, uv, 0.0).rgb;
    float own = seen_here.r;
    float before = 0.0, count = 0.0, like_before = 0.0, like_background = 0.0;
    for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) {
            ivec2 there = clamp(at + step_px * ivec2(x, y), ivec2(0), size - 1);
            float kind = textureLod(seen, (vec2(there) + 0.5) * texel, 0.0).r;
            float is_before = is_kind(kind, before_background) ? 1.0 : 0.0, is_background = is_kind(kind, undecided) || is_kind(kind, uncovered) ? 0.0 : 1.0 - is_before;
            float is_known = is_kind(kind, new_background) ? 0.0 : is_background;
            before += is_before;
            count += is_before + is_background;
            vec3 off = abs(texelFetch(picture, there, 0).rgb - now);
            float w = exp(-(off.r + off.g + off.b) / (3.0 * like_colour)) + 1e-3;
            like_before += w * is_before;
            like_background += w * is_known;
        }
    if (is_kind(own, uncovered)) performer = 1.0;
    if (before == 0.0 || performer > 0.0) return;
    float around = before / max(count, 1.0);
    bool is_foreground = is_kind(own, before_background) ? around > least_around && (seen_here.b > like_background_here || like_before > like_background)
                        : is_kind(own, undecided)   ? like_before > like_background
                        : is_kind(own, new_background)  ? around > new_around && like_before > like_background
                                                 : around > most_around;
    performer = is_foreground ? 1.0 : 0.0;
}
