// What the passes of the stereo engine share. Every picture-shaped buffer has rows of `stride` pixels, a multiple
// of four that is no multiple of 4096 bytes for the volume (rows would share their cache lines' places).
#ifndef LANES
#define LANES 16
#endif

// How invocations lie over the work. Lanes along pixels keep CPUs and wide GPUs fed; lanes along disparities put
// the 16-byte pieces of one pixel side by side and need half the registers, which suits a Raspberry Pi's V3D.
#define LANES_PIXELS 0
#define LANES_DISPARITIES 1
#ifndef LANE_MAPPING
#define LANE_MAPPING LANES_PIXELS
#endif

// The right-hand feature of a pixel outside the picture: half its census bits agree with anything.
const uint outside_word = 0x82aaaaaau;

// The byte of a luma word that holds pixel i = 0..3 of it.
uint byte_of(uint word, int i) { return (word >> (8 * i)) & 255u; }
