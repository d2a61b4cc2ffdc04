// Learns the depth of a rig's background over time where no foreground hides it. Where the colour stays, a different depth
// is accepted only after several instants; where the colour changed, at once.
#include "depth_weights.glsl"
#include "background_kinds.glsl"

uniform sampler2D depth_map;   // this instant's, metres, 0 = unknown
uniform sampler2D background_before;  // background_state of the instant before
uniform sampler2D seen;        // from background_compare.frag
uniform sampler2D matte;       // the foreground's share
uniform float absorbed_after;  // instants after which foreground that stands still becomes background

layout(location = 0) out vec4 background_state;  // the background's depth in metres and its count (see depth_weights.glsl); the depth that may replace it and its instants

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float z = texelFetch(depth_map, at, 0).r;
    background_state = vec4(z, 1.0, 0.0, 0.0);
    if (has_before == 0.0) return;
    background_state = texelFetch(background_before, at, 0);
    vec2 uv = gl_FragCoord.xy / vec2(textureSize(depth_map, 0));
    float hidden = textureLod(matte, uv, 0.0).r, kind = texelFetch(seen, at, 0).r;
    if (hidden > 0.0) {
        if (z == 0.0) return;
        bool goes_on = background_state.b > 0.0 && is_one_surface(z, background_state.b);
        background_state.zw = goes_on ? vec2(mix(background_state.b, z, 1.0 / (background_state.a + 1.0)), background_state.a + 1.0) : vec2(z, 1.0);
        if (background_state.a >= absorbed_after) background_state = vec4(background_state.b, 1.0, 0.0, 0.0);
        return;
    }
    background_state.zw = vec2(0.0);
    if (z == 0.0) return;
    if (background_state.r <= 0.0 || is_kind(kind, new_background) || is_kind(kind, undecided))
        background_state.xy = vec2(z, 1.0);
    else if (!is_kind(kind, before_background))
        background_state.xy = updated(background_state.xy, z, is_one_surface(z, background_state.r), mean_share(background_state.xy));
}
