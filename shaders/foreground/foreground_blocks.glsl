// Side of the blocks of pixels that foreground_far.frag computes one depth for.
const int block_px = 4;
