// Formats of a camera's planes, and the conversion of YUV. YUV is BT.601 of limited range in the fixed point of 20 bits
// that OpenCV has, so that a picture that is converted here and one that is converted on the processor are the same to
// the bit.
#ifndef FORMAT
#define FORMAT 0  // 0: grey; 1: Y10; 2: Y16; 3: YUYV; 4: NV12
#endif

// Red, green and blue in grey levels.
vec3 rgb_of_yuv(int y, int u, int v) {
    const int shift = 20, half_unit = 1 << 19;
    int luma = max(y - 16, 0) * 1220542;
    u -= 128;
    v -= 128;
    ivec3 rgb = ivec3(luma + half_unit + 1673527 * v,
                      luma + half_unit - 852492 * v - 409993 * u, luma + half_unit + 2116026 * u);
    return vec3(clamp(rgb >> shift, 0, 255));
}
