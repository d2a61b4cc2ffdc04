// A depth that stays that of most instants (Boyer and Moore's vote): those that agree count up, to MOST_VOTES, those
// that do not count down, and at none another takes its place.
#ifndef MOST_VOTES
#define MOST_VOTES 4.0
#endif

const float share_of_new = 0.3;

// before: metres, votes. What agrees is averaged in inverse depth.
vec2 voted(vec2 before, float now, bool agrees) {
    if (agrees)
        return vec2(now == before.r ? now : 1.0 / mix(1.0 / before.r, 1.0 / now, share_of_new),
                    min(before.g + 1.0, MOST_VOTES));
    return before.g > 1.0 ? vec2(before.r, before.g - 1.0) : vec2(now, 1.0);
}
