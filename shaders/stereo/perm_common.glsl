// Permeability aggregation (Cigla, Alatan 2013). Sums live in registers as 16-bit pairs, four words for 8 disparities;
// horizontal sums lie in memory as bytes, two words: half of the range in the even bytes, half in the odd ones. A cost
// is at most 31, a horizontal sum 31 * 31 / 8, a vertical one 16 times that: the 12 bits that permeate() takes are
// never left. Vertical sums keep all their bits: what is lost there decides in untextured places.
#include "stereo_common.glsl"

// Two 12-bit values times mu / 16, mu = 0..15, in one multiplication.
uvec4 permeate(uvec4 pairs, uint mu) { return ((pairs * mu) >> 4) & 0x0fff0fffu; }

const uint low_bytes = 0x00ff00ffu;
uvec2 bytes_of(uvec4 pairs) { return (pairs.xy & low_bytes) | ((pairs.zw & low_bytes) << 8); }
uvec4 pairs_of(uvec2 bytes) { return uvec4(bytes & low_bytes, (bytes >> 8) & low_bytes); }

// The shorter way between the upper five bits, on a circle of 32, in units of 1 << 27; at most `most`.
uint way(uint a, uint b, uint most) {
    const uint upper = 0xf8000000u;
    return min(uint(abs(int((a & upper) - (b & upper)))), most << 27);
}

// Where lanes lie along disparities, of GPUs without an instruction that counts bits: a 17-bit census takes fewer steps
// than a word, and the sum is left at bit 26, where the doubled differences of the other fields lie.
#if LANE_MAPPING == LANES_DISPARITIES
// Of the two differences of a circle, the smaller one; a V3D subtracts beside its other operations, and negates instead of
// them.
uint narrow_way(uint a, uint b, uint most) {
    const uint upper = 0xf8000000u;
    uint left = a & upper, right = b & upper;
    return min(min(left - right, right - left), most << 27);
}
// The cost in the upper six bits. The lower 26 are to be ignored: of two such words the lesser one has the lesser cost.
uint upper_cost_of(uint left, uint right) {
    uint bits = left ^ right;
    // Groups of three bits, then of six. Bits 17 and above are none of the census.
    uint threes = bits - ((bits >> 1) & 0xb6dbu) - ((bits >> 2) & 0x1249u);
    uint sixes = (threes & 0x71c7u) + ((threes >> 3) & 0x31c7u);
    uint census = min(sixes * (0x1041u << 14), (10u << 26) - 1u);
    uint ways = narrow_way(left, right, 3u) + narrow_way(left << 10, right << 10, 4u) +
                narrow_way(left << 5, right << 5, 4u);
    return census + ways;
}
uint cost_of(uint left, uint right) { return upper_cost_of(left, right) >> 26; }
#else
// Truncated census distance plus truncated differences of both gradients and of colour, 0..31.
uint cost_of(uint left, uint right) {
    uint census = uint(bitCount((left ^ right) & 0x1ffffu));
    // Across, down and of colour: all three together are less than a turn of the circle.
    uint ways = way(left, right, 3u) + way(left << 10, right << 10, 4u) + way(left << 5, right << 5, 4u);
    return min(census, 9u) + (ways >> 26);
}
#endif
