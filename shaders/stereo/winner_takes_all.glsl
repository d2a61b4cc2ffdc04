// The best disparity so far of a pixel with the costs beside it (for sub-pixel positions), as slabs of 16 disparities
// come by: two 12-bit costs a word, a before b, the lower disparity in the lower half. 0xfff: there is no such cost.
uint best = 0xfffu, best_d = 0xffu, before = 0xfffu, after = 0xfffu, last = 0xfffu;

// The least cost with its index below it: the minimum of two words is one of their upper halves.
#define CONSIDER(k, w)                                                  \
    {                                                                   \
        uint keys = (w << 4) | (uint(2 * k) | (uint(2 * k + 1) << 16)); \
        if (2 * k < valid) least_low = min(least_low, keys << 16);      \
        if (2 * k + 1 < valid) least_high = min(least_high, keys);      \
    }
uint least_of(uvec4 a, uvec4 b, int valid) {
    uint least_low = ~0u, least_high = ~0u;
    CONSIDER(0, a.x) CONSIDER(1, a.y) CONSIDER(2, a.z) CONSIDER(3, a.w)
    CONSIDER(4, b.x) CONSIDER(5, b.y) CONSIDER(6, b.z) CONSIDER(7, b.w)
    return min(least_low >> 16, least_high >> 16);
}

uint cost_at(uint i, uvec4 a, uvec4 b) {
    uvec4 four = (i & 8u) != 0u ? b : a;
    uvec2 two = (i & 4u) != 0u ? four.zw : four.xy;
    uint one = (i & 2u) != 0u ? two.y : two.x;
    return (i & 1u) != 0u ? one >> 16 : one & 0xffffu;
}

// `valid`, a constant: how many of the 16 count.
void consider_slab(int first_disparity, uvec4 a, uvec4 b, int valid) {
    after = best_d + 1u == uint(first_disparity) ? a.x & 0xffffu : after;
    uint least = least_of(a, b, valid), i = least & 15u;
    bool wins = (least >> 4) < best;
    best = wins ? least >> 4 : best;
    best_d = wins ? uint(first_disparity) + i : best_d;
    before = wins ? (i == 0u ? last : cost_at(i - 1u, a, b)) : before;
    after = wins ? (i == uint(valid - 1) ? 0xfffu : cost_at(i + 1u, a, b)) : after;
    last = b.w >> 16;
}

// A pixel's winner in memory. x: cost << 20 | disparity << 12 | cost of the last disparity seen; y: cost of the
// disparity before the best << 12 | of the one after.
uvec2 winner() { return uvec2((best << 20) | (best_d << 12) | last, (before << 12) | after); }
void no_winner_yet() { best = 0xfffu, best_d = 0xffu, before = 0xfffu, after = 0xfffu, last = 0xfffu; }
void resume_winner(uvec2 state) {
    best = state.x >> 20;
    best_d = (state.x >> 12) & 255u;
    last = state.x & 0xfffu;
    before = state.y >> 12;
    after = state.y & 0xfffu;
}
