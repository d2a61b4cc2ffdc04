// By what factor a picture is brighter than the one before, from a grid of samples: the ratio of their sums, of those
// that differ little, taken twice, the second time of those that differ little from the first ratio. What moves differs
// more and does not count. A ratio that noise alone would make is 1. One workgroup.
#ifndef LANES
#define LANES 64
#endif
#ifndef COLUMNS
#define COLUMNS 32  // of the grid
#endif
#ifndef ROWS
#define ROWS 24
#endif
#ifndef MOST_FIRST_STEP
#define MOST_FIRST_STEP 24  // grey levels
#endif
#ifndef MOST_STEP
#define MOST_STEP 8
#endif
#ifndef LEAST_CHANGE
#define LEAST_CHANGE 8  // 1/4096
#endif

layout(local_size_x = LANES) in;
layout(std430, binding = 0) buffer Exposure { int gain_4096; int luma[]; };  // luma: of the picture before
uniform highp sampler2D picture;
uniform int has_luma;

shared int now, before, count;

int luma_of(int i) {
    ivec2 size = textureSize(picture, 0), at = ivec2(i % COLUMNS, i / COLUMNS);
    ivec4 c = ivec4(texelFetch(picture, ((2 * at + 1) * size) / ivec2(2 * COLUMNS, 2 * ROWS), 0) * 255.0 + 0.5);
    return (77 * c.r + 150 * c.g + 29 * c.b + 128) >> 8;
}

int gain_of(int gain, int most_step) {
    if (gl_LocalInvocationID.x == 0u) now = 0, before = 0, count = 0;
    barrier();
    for (int i = int(gl_LocalInvocationID.x); i < COLUMNS * ROWS; i += LANES) {
        int here = luma_of(i);
        if (abs(here - ((luma[i] * gain + 2048) >> 12)) > most_step) continue;
        atomicAdd(now, here);
        atomicAdd(before, luma[i]);
        atomicAdd(count, 1);
    }
    barrier();
    int result = count * 4 >= COLUMNS * ROWS && before > 0 ? now * 4096 / before : 4096;
    barrier();
    return result;
}

void main() {
    int gain = 4096;
    if (has_luma != 0) {
        gain = gain_of(gain, MOST_FIRST_STEP);
        gain = gain_of(gain, MOST_STEP);
        gain = abs(gain - 4096) < LEAST_CHANGE ? 4096 : clamp(gain, 3072, 5461);
    }
    for (int i = int(gl_LocalInvocationID.x); i < COLUMNS * ROWS; i += LANES) luma[i] = luma_of(i);
    if (gl_LocalInvocationID.x == 0u) gain_4096 = gain;
}
