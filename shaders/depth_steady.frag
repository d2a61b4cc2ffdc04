// Filters a rig's depth along time: where neither the picture nor, beyond its uncertainty, the depth has changed, it is
// the mean of the instants. Where the depth alone jumped, a matcher wavers between two surfaces: it stays what it was
// until it has changed for good.
#include "depth_votes.glsl"

uniform sampler2D depth_map;      // this instant's, metres, 0 = unknown
uniform sampler2D steady_before;  // what came of the instants before: metres, votes
uniform sampler2D picture_mean;   // alpha: 0 where the picture has just changed

layout(location = 0) out vec2 steady;  // metres, votes; none where the picture has changed

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float now = texelFetch(depth_map, at, 0).r;
    steady = vec2(now, 0.0);
    if (has_before == 0.0) return;
    vec4 instants = textureGather(picture_mean, gl_FragCoord.xy / vec2(textureSize(depth_map, 0)), 3);
    if (min(min(instants.x, instants.y), min(instants.z, instants.w)) == 0.0) return;
    steady.g = 1.0;
    vec2 before = texelFetch(steady_before, at, 0).rg;
    if (before.r <= 0.0) return;
    before.g = max(before.g, 1.0);
    steady = now > 0.0 ? voted(before, now, is_one_surface(now, before.r), mean_share(before)) : before;
}
