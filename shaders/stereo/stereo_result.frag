// The last pass: disparities from their buffer into the result, and with CONFIDENCE 1 also how sure each is.
#ifndef CONFIDENCE
#define CONFIDENCE 0
#endif

#ifndef HALVES
#define HALVES 0
#endif

layout(std430, binding = 0) readonly buffer Disparity { uint disparity[]; };  // 1/32 px | confidence << 16; HALVES: two 1/32 px
uniform int stride;
layout(location = 0) out uint result;
#if CONFIDENCE
layout(location = 1) out uint confidence;
#endif

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
#if HALVES
    result = (disparity[(at.y * stride + at.x) >> 1] >> (16 * (at.x & 1))) & 0xffffu;
#else
    uint word = disparity[at.y * stride + at.x];
    result = word & 0xffffu;
#endif
#if CONFIDENCE
    confidence = word >> 16;
#endif
}
