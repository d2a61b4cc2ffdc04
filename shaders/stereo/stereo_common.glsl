// What the passes of the stereo engine share. Picture-shaped buffers have rows of `stride` pixels, a multiple
// of four.
#ifndef LANES
#define LANES 16  // of passes that walk lines: there are only so many lines
#endif
#ifndef PICTURE_LANES
#define PICTURE_LANES 128  // of passes over pixels: a workgroup has its price
#endif

// How invocations lie over the work. Lanes along pixels keep CPUs and wide GPUs fed; lanes along disparities put
// the 16-byte pieces of one pixel side by side and need half the registers, which suits a Raspberry Pi's V3D.
#define LANES_PIXELS 0
#define LANES_DISPARITIES 1
#ifndef LANE_MAPPING
#define LANE_MAPPING LANES_PIXELS
#endif

// Words to be stored, none of which is ~0. Without a last operation that has no simple form llvmpipe's compiler takes
// the ones before it apart into scalar ones, lane by lane. (Measured; it pays where much is packed into each word.)
uint whole(uint word) { return min(word, 0xfffffffeu); }
uvec2 whole(uvec2 words) { return min(words, uvec2(0xfffffffeu)); }
uvec4 whole(uvec4 words) { return min(words, uvec4(0xfffffffeu)); }

// The byte of a luma word that holds pixel i = 0..3 of it.
uint byte_of(uint word, int i) { return (word >> (8 * i)) & 255u; }

// Rounded means of two squares of 2x2 pixels that lie in luma words above each other, a 16-bit half each.
uint means_of_2x2(uint above, uint below) {
    const uint low_bytes = 0x00ff00ffu;
    uint sums = (above & low_bytes) + ((above >> 8) & low_bytes) + (below & low_bytes) + ((below >> 8) & low_bytes);
    return ((sums + 0x00020002u) >> 2) & low_bytes;
}

// The pieces that columns are walked in lie in blocks of 16 pixels' width, row under row, so that a walk down is one
// through memory. A buffer of them has rows of whole blocks.
const int block_px = 16;
int block_at(int x, int y, int height) { return ((x >> 4) * height + y) * block_px + (x & (block_px - 1)); }
