// Keeps the depth that is drawn of a rig steady where its picture stands still: what the rigs decide together (what is
// carved, adopted or guessed) would waver with their noise. The depth stays that of most instants (Boyer and Moore's
// vote, as in depth_steady.frag); a guess (negative) and a measured depth are two.
#ifndef MOST_VOTES
#define MOST_VOTES 4.0
#endif

uniform sampler2D fresh;     // this instant's, metres, 0 = unknown, negative = guessed
uniform sampler2D steady;    // from depth_steady.frag: no votes where the picture has changed
uniform sampler2D before;    // what came of the instants before: metres, votes
uniform float softness;      // relative depth within which two surfaces are one
uniform float spread;        // relative uncertainty of depth, per metre of depth
uniform float has_before;    // 0: there is no instant before

layout(location = 0) out vec2 settled;

const float share_of_new = 0.3;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float now = texelFetch(fresh, at, 0).r;
    settled = vec2(now, 1.0);
    if (has_before == 0.0 || texelFetch(steady, at, 0).g == 0.0) return;
    vec2 old = texelFetch(before, at, 0).rg;
    bool is_same = now == old.r || (now * old.r > 0.0 && abs(now / old.r - 1.0) < softness + 4.0 * spread * abs(now));
    if (is_same)
        settled = vec2(now == old.r ? now : 1.0 / mix(1.0 / old.r, 1.0 / now, share_of_new),
                       min(old.g + 1.0, MOST_VOTES));
    else if (old.g > 1.0)
        settled = vec2(old.r, old.g - 1.0);
}
