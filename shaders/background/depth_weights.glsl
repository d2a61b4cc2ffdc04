// The temporal mean of a background depth. A depth is replaced only after as many different ones in a row as instants that
// the picture has stood still, within bounds, so that a matcher whose result alternates does not make the depth flicker.
#include "tolerances.glsl"
uniform float spread;      // relative uncertainty of depth, per metre of depth
uniform float has_before;  // 0: there is no instant before
uniform float most_instants;  // of the mean
uniform float most_misses;    // in a row, after which a depth has changed, at most

const float min_misses = 2.0;        // the same, at least
const float one_miss = 1.0 / 32.0;  // what a miss adds to the count

bool is_one_surface(float now, float before) { return abs(now / before - 1.0) < steady_surface_share + surface_sigmas * spread * abs(now); }

// The new depth's weight in the mean.
float mean_share(vec2 before) { return 1.0 / (floor(before.g) + 1.0); }

// The next state of a depth: metres, and its count, whose whole part is the instants that the pixel stood still and whose
// fraction is the misses since the last depth of the same surface. Depths of one surface are averaged as inverse depths.
vec2 updated(vec2 before, float now, bool is_same, float share) {
    float instants = floor(before.g);
    if (is_same)
        return vec2(now == before.r || share == 0.0 ? before.r : 1.0 / mix(1.0 / before.r, 1.0 / now, share),
                    min(instants + 1.0, most_instants));
    float patience = clamp(instants, min_misses, most_misses), count = before.g + one_miss;
    return count - instants < one_miss * patience ? vec2(before.r, count)
                                                  : vec2(now, min(instants + patience, most_instants));
}
