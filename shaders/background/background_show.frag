// The depth of a rig's background at this instant, behind its foreground too. An uncovered surface is shown before it is
// learnt; a place that was never visible is unknown.
#include "background_kinds.glsl"
#include "background_known.glsl"
#include "background_now.glsl"

uniform sampler2D depth_map;    // this instant's, metres, 0 = unknown
uniform sampler2D seen;         // from background_compare.frag
uniform sampler2D performers;   // depth of the foreground, metres, 0 = none
uniform sampler2D colour;       // from background_colour.frag: alpha is 1 where the background is visible now
uniform sampler2D colour_mean;  // the mean of background_colour.frag

layout(location = 0) out float depth_m;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 uv = gl_FragCoord.xy / vec2(textureSize(model, 0));
    float z = texelFetch(depth_map, at, 0).r;
    bool has_performer = texelFetch(performers, at, 0).r > 0.0;
    if (z > 0.0 && is_kind(texelFetch(seen, at, 0).r, uncovered) && !has_performer) {
        depth_m = z;
        return;
    }
    vec4 state = texelFetch(background_state, at, 0);
    depth_m = background_depth_m(at, state);
    bool is_hidden = textureLod(colour, uv, 0.0).a < 1.0;
    if (is_hidden && !is_background_known(state, textureLod(colour_mean, uv, 0.0))) depth_m = 0.0;
}
