// The kinds of pixels in background_compare.frag, as stored in 8 bits: the background; the background in other light;
// undecided; the background where it has changed; a surface farther than the background, not yet seen for long enough to
// replace it; something before the background.
const float the_background = 0.0, lit_background = 64.0 / 255.0, undecided = 112.0 / 255.0, new_background = 152.0 / 255.0,
            uncovered = 192.0 / 255.0, before_background = 1.0;

bool is_kind(float seen, float kind) { return abs(seen - kind) < 0.05; }

// Whether a pixel does not, or does not yet, show the background.
bool is_apart(float seen) { return seen > 0.7; }
