// Permeability aggregation (Cigla, Alatan 2013) in 16-bit pairs: the low half of a word holds the even disparity,
// the high half the odd one. A cost is at most 26, a horizontal sum 26 * 16 * 2 / 8, a vertical one 16 times that:
// the 12 bits that permeate() takes are never left.
#include "stereo_common.glsl"

// Two 12-bit values times mu / 16, mu = 0..15, in one multiplication.
uvec4 permeate(uvec4 pairs, uint mu) { return ((pairs * mu) >> 4) & 0x0fff0fffu; }

// Truncated census distance plus truncated gradient difference, 0..26.
uint cost_of(uint left, uint right) {
    uint census = uint(bitCount((left ^ right) & 0x07ffffffu));
    uint gradient = uint(abs(int(left >> 27) - int(right >> 27)));
    return min(census, 16u) + min(2u * gradient, 10u);
}
