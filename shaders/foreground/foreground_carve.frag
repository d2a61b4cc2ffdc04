// Keeps of a rig's performers the depth that all other rigs' mattes allow. Where one sees its set, the closest depth on
// the pixel's ray counts at which two of them see a performer: a plain surface errs along the ray, not out of the matte.
#include "other_silhouettes.glsl"
#include "background_kinds.glsl"

uniform sampler2D depth_map;  // this instant's, metres, 0 = unknown
uniform sampler2D seen;       // from background_compare.frag
uniform sampler2D matte;      // the performers' share

layout(location = 0) out float carved;  // metres, 0 = unknown

const int steps = 4;
const float step_share = 0.02;  // of depth, from one to the next

bool is_seen_by_two(vec2 pixel, float z) { return look_at_silhouettes(pixel, z) > 1; }

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    carved = 0.0;
    vec2 uv = gl_FragCoord.xy / vec2(textureSize(depth_map, 0));
    float kind = texelFetch(seen, at, 0).r, z = texelFetch(depth_map, at, 0).r;
    if (textureLod(matte, uv, 0.0).r < 0.1 || !is_kind(kind, before_background) || z == 0.0) return;
    vec2 pixel = vec2(at);
    if (look_at_silhouettes(pixel, z) >= 0) carved = z;
    for (int k = 1; k <= steps && carved == 0.0; ++k) {
        float ratio = 1.0 + float(k) * step_share;
        if (is_seen_by_two(pixel, z * ratio))
            carved = z * ratio;
        else if (is_seen_by_two(pixel, z / ratio))
            carved = z / ratio;
    }
}
