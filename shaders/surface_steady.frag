// Keeps the depth that is drawn of a rig steady where its picture stands still: what the rigs decide together (what is
// carved, adopted or guessed) would waver with their noise. A guess (negative) and a measured depth are two.
#include "depth_votes.glsl"

uniform sampler2D fresh;   // this instant's, metres, 0 = unknown, negative = guessed
uniform sampler2D steady;  // from depth_steady.frag: no votes where the picture has changed
uniform sampler2D before;  // what came of the instants before: metres, votes

layout(location = 0) out vec2 settled;

uniform float held_from;  // instants: a depth that wavers within its uncertainty is not moved any more

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float now = texelFetch(fresh, at, 0).r;
    settled = vec2(now, 1.0);
    if (has_before == 0.0 || texelFetch(steady, at, 0).g == 0.0) return;
    vec2 old = texelFetch(before, at, 0).rg;
    bool is_same = now == old.r || (now * old.r > 0.0 && is_one_surface(now, old.r));
    settled = voted(old, now, is_same, old.g < held_from ? mean_share(old) : 0.0);
}
