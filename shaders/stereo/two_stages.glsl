// A pass in two stages (see TwoStagePass): the first, with FIRST, draws every pixel and leaves some to the second by their
// depth.
#ifndef FIRST
#define FIRST 0
#endif

void leave_to_second(bool is_left) {
#if FIRST
    gl_FragDepth = is_left ? 0.75 : 0.25;
#endif
}
