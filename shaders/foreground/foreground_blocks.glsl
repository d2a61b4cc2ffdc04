// The blocks of pixels for which foreground_far.frag finds a depth.
const int block_px = 4;  // sides
