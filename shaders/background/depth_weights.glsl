// A depth that stays until as many instants in a row say otherwise as the picture has stood still, within bounds: a
// matcher that finds another depth every time is not followed every time.
uniform float softness;    // relative depth within which two surfaces are one
uniform float spread;      // relative uncertainty of depth, per metre of depth
uniform float has_before;  // 0: there is no instant before
uniform float most_instants;  // of the mean
uniform float most_misses;    // in a row, after which a depth has changed for good

const float fewest_misses = 2.0;
const float one_miss = 1.0 / 32.0;

bool is_one_surface(float now, float before) { return abs(now / before - 1.0) < softness + 4.0 * spread * abs(now); }

// The new one's part in the mean of all that agree.
float mean_share(vec2 before) { return 1.0 / (floor(before.g) + 1.0); }

// before, and what comes of it: metres; instants that stood still, and as its fraction those that did not agree since
// one did. What agrees is averaged in inverse depth.
vec2 voted(vec2 before, float now, bool agrees, float share) {
    float instants = floor(before.g);
    if (agrees)
        return vec2(now == before.r || share == 0.0 ? before.r : 1.0 / mix(1.0 / before.r, 1.0 / now, share),
                    min(instants + 1.0, most_instants));
    float patience = clamp(instants, fewest_misses, most_misses), votes = before.g + one_miss;
    return votes - instants < one_miss * patience ? vec2(before.r, votes)
                                                  : vec2(now, min(instants + patience, most_instants));
}
