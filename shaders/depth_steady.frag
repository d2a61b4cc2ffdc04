// Filters a rig's depth along time: where the picture did not change and neither did the depth, beyond its
// uncertainty, the depth of the instants before is worth as much as this one's. Where the picture did not change and
// the depth jumped, a matcher wavers between two surfaces: the depth stays that of most instants.
#include "depth_votes.glsl"

uniform sampler2D depth_map;       // this instant's, metres, 0 = unknown
uniform sampler2D picture;
uniform sampler2D steady_before;   // what came of the instants before: metres, votes
uniform sampler2D picture_before;
uniform float softness;            // relative depth within which two surfaces are one
uniform float spread;              // relative uncertainty of depth, per metre of depth
uniform float has_before;          // 0: there is no instant before

layout(location = 0) out vec2 steady;  // metres, votes; none where the picture has changed

const float still = 0.05;  // mean colour change (0..1) of a window; sensor noise stays well below it

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float now = texelFetch(depth_map, at, 0).r;
    steady = vec2(now, 0.0);
    if (has_before == 0.0) return;
    vec2 before = texelFetch(steady_before, at, 0).rg;
    vec2 texel = 1.0 / vec2(textureSize(depth_map, 0));
    vec2 uv = (vec2(at) + 0.5) * texel;
    vec3 change = vec3(0.0);
    for (int k = 0; k < 9; ++k) {
        vec2 there = uv + texel * vec2(ivec2(k % 3, k / 3) - 1);
        change += textureLod(picture, there, 0.0).rgb - textureLod(picture_before, there, 0.0).rgb;
    }
    change = abs(change) / 9.0;
    if (max(change.r, max(change.g, change.b)) > still) return;
    steady.g = 1.0;
    if (before.r <= 0.0) return;
    steady = now > 0.0 ? voted(before, now, abs(now / before.r - 1.0) < softness + 4.0 * spread * now)
                       : vec2(before.r, max(before.g, 1.0));
}
