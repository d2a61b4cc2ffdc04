// Winners to disparities in 1/32 px; a match at infinity reads 1, since 0 means unknown. A winner
// that points beyond the right picture's edge has no match: it takes the disparity of the next match
// to its right (there is only background to fill from on that side), or stays unknown.
#ifndef FILL
#define FILL 1
#endif
layout(std430, binding = 0) readonly buffer Keys { uint keys[]; };
uniform ivec2 size;
layout(location = 0) out uint disparity;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    int row = at.y * size.x;
    int d = int(keys[row + at.x] & 255u);
    bool has_match = d <= at.x;
#if FILL
    for (int x = at.x + 1; !has_match && x < size.x; ++x) {
        d = int(keys[row + x] & 255u);
        has_match = d <= x;
    }
#endif
    disparity = has_match ? uint(max(32 * d, 1)) : 0u;
}
