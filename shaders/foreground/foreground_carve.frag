// Keeps the foreground depth of a rig that all other rigs' mattes allow. Where another rig sees its background instead,
// takes the closest depth on the pixel's ray at which two rigs see foreground: the depth of a plain surface errs along
// the ray, not out of the matte.
#include "other_silhouettes.glsl"
#include "background_kinds.glsl"

uniform sampler2D depth_map;  // this instant's depth, metres, 0 = unknown
uniform sampler2D seen;       // from background_compare.frag
uniform sampler2D matte;      // the foreground's share of each pixel

layout(location = 0) out float carved;  // metres, 0 = unknown

const int steps = 4;  // along the ray to either side
const float step_share = 0.02;  // relative depth from one step to the next

bool is_seen_by_two(vec2 pixel, float z) { return look_at_silhouettes(pixel, z) > 1; }

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    carved = 0.0;
    vec2 uv = gl_FragCoord.xy / vec2(textureSize(depth_map, 0));
    float kind = texelFetch(seen, at, 0).r, z = texelFetch(depth_map, at, 0).r;
    if (textureLod(matte, uv, 0.0).r < 0.1 || !is_kind(kind, before_background) || z == 0.0) return;
    vec2 pixel = vec2(at);
#ifdef WITHOUT_SILHOUETTES  // tests/bench/step_worth.py
    carved = z;
    return;
#endif
    if (look_at_silhouettes(pixel, z) >= 0) carved = z;
    for (int k = 1; k <= steps && carved == 0.0; ++k) {
        float ratio = 1.0 + float(k) * step_share;
        if (is_seen_by_two(pixel, z * ratio))
            carved = z * ratio;
        else if (is_seen_by_two(pixel, z / ratio))
            carved = z / ratio;
    }
}
