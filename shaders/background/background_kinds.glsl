// What a pixel of a rig shows, in 255ths: the set itself; the set in another light; what cannot be told; the set where it
// was changed; what is farther than the set was known to be, for too short to believe it; what stands before the set.
const float the_set = 0.0, lit_background = 64.0 / 255.0, untold = 112.0 / 255.0, new_background = 152.0 / 255.0, uncovered = 192.0 / 255.0,
            before_background = 1.0;

bool is_kind(float seen, float kind) { return abs(seen - kind) < 0.05; }

// What is not, or not yet, a part of the set.
bool is_apart(float seen) { return seen > 0.7; }
