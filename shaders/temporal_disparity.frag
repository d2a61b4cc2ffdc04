// Steadies the disparities of a stream: where a pixel looks as it did and its disparity is near what it was, a running
// mean (a quarter of the way to the new value) stands in for the new value; everywhere else the new value counts at
// once, so that nothing trails.
uniform highp usampler2D disparity;  // 1/32 px, 0 = unknown
uniform sampler2D picture;           // rgba8, what the disparities belong to
uniform highp usampler2D state;      // the last frame's: mean disparity in 1/8192 px << 8 | luma
uniform int has_state;

layout(location = 0) out uint steadied;
layout(location = 1) out uint next_state;

// Grey levels that the five pixels of a cross may differ by, all together; 1/8192 px that a disparity may.
#ifndef MOST_CHANGE
#define MOST_CHANGE 40
#endif
#ifndef MOST_STEP
#define MOST_STEP 12288
#endif

int luma_at(ivec2 at) {
    ivec4 c = ivec4(texelFetch(picture, at, 0) * 255.0 + 0.5);
    return (77 * c.r + 150 * c.g + 29 * c.b + 128) >> 8;
}
int change_at(ivec2 at, ivec2 last) {
    at = clamp(at, ivec2(0), last);
    return abs(luma_at(at) - int(texelFetch(state, at, 0).r & 255u));
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(disparity, 0) - 1;
    int now = int(texelFetch(disparity, at, 0).r) << 8, luma = luma_at(at), mean = now;
    if (has_state != 0 && now != 0) {
        int before = int(texelFetch(state, at, 0).r >> 8);
        int change = change_at(at, last) + change_at(at + ivec2(1, 0), last) + change_at(at - ivec2(1, 0), last) +
                     change_at(at + ivec2(0, 1), last) + change_at(at - ivec2(0, 1), last);
        bool is_still = before != 0 && change <= MOST_CHANGE && abs(now - before) <= MOST_STEP;
        mean = is_still ? before + ((now - before) >> 2) : now;
    }
    steadied = now == 0 ? 0u : uint(max((mean + 128) >> 8, 1));
    next_state = (uint(mean) << 8) | uint(luma);
}
