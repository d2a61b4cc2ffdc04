// Steadies the disparities of a stream. Where a pixel looks as it did, it keeps the disparity that most frames agree on:
// what is near moves a running mean, what is not is outvoted until it has come more often. Where the pixel looks
// different the new value counts at once, so that nothing trails.
uniform highp usampler2D disparity;  // 1/32 px, 0 = unknown
uniform sampler2D picture;           // rgba8, what the disparities belong to
uniform highp usampler2D state;      // the last frame's: mean disparity in 1/1024 px << 13 | votes << 8 | mean luma
layout(std430, binding = 0) readonly buffer Exposure { int gain_4096; };  // of the picture since the last frame
uniform int has_state;

layout(location = 0) out uint denoised;
layout(location = 1) out uint next_state;

// See temporal_reference.h.
#ifndef MOST_CHANGE
#define MOST_CHANGE 40
#endif
#ifndef MOST_HOLDING_CHANGE
#define MOST_HOLDING_CHANGE 20
#endif
#ifndef MOST_STEP
#define MOST_STEP 1536
#endif
#ifndef VOTES
#define VOTES 2
#endif
#ifndef FIRST_VOTES
#define FIRST_VOTES 4
#endif
#ifndef MOST_VOTES
#define MOST_VOTES 15
#endif

int luma_at(ivec2 at) {
    ivec3 c = ivec3(roundEven(texelFetch(picture, at, 0).rgb * 255.0));
    return (77 * c.r + 150 * c.g + 29 * c.b + 128) >> 8;
}
int exposed(uint state) { return min((int(state & 255u) * gain_4096 + 2048) >> 12, 255); }
int change_at(ivec2 at) { return abs(luma_at(at) - exposed(texelFetch(state, at, 0).r)); }

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(disparity, 0) - 1;
    int now = min(int(texelFetch(disparity, at, 0).r) << 5, 0x7ffff), luma = luma_at(at), mean = now, votes = 0;
    if (has_state != 0 && now != 0) {
        uint before = texelFetch(state, at, 0).r;
        int mean_before = int(before >> 13), votes_before = int(before >> 8) & 31;
        int change = abs(luma - exposed(before)) + change_at(ivec2(min(at.x + 1, last.x), at.y)) +
                     change_at(ivec2(max(at.x - 1, 0), at.y)) + change_at(ivec2(at.x, min(at.y + 1, last.y))) +
                     change_at(ivec2(at.x, max(at.y - 1, 0)));
        if (change <= MOST_CHANGE) luma = exposed(before) + ((luma - exposed(before) + 2) >> 2);
        bool agrees = abs(now - mean_before) <= MOST_STEP;
        if (mean_before != 0 && agrees && change <= MOST_CHANGE) {
            mean = mean_before + ((now - mean_before) >> (votes_before < 8 ? 2 : 3));
            votes = min(votes_before + VOTES, MOST_VOTES);
        } else if (mean_before != 0 && !agrees && change <= MOST_HOLDING_CHANGE) {
            mean = votes_before > 0 ? mean_before : now;
            votes = votes_before > 0 ? votes_before - 1 : FIRST_VOTES;
        }
    }
    denoised = now == 0 ? 0u : uint(max((mean + 16) >> 5, 1));
    next_state = (uint(mean) << 13) | (uint(votes) << 8) | uint(luma);
}
