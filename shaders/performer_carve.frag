// Keeps of a rig's performers the depth that all other rigs' mattes allow.
#include "other_silhouettes.glsl"
#include "set_kinds.glsl"

uniform sampler2D depth_map;  // this instant's, metres, 0 = unknown
uniform sampler2D seen;       // from set_see.frag
uniform sampler2D matte;      // the performers' share

layout(location = 0) out float carved;  // metres, 0 = unknown

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    carved = 0.0;
    vec2 uv = gl_FragCoord.xy / vec2(textureSize(depth_map, 0));
    float kind = texelFetch(seen, at, 0).r, z = texelFetch(depth_map, at, 0).r;
    if (textureLod(matte, uv, 0.0).r < 0.1 || !is_kind(kind, before_set) || z == 0.0) return;
    if (look_at_silhouettes(vec2(at), z) >= 0) carved = z;
}
