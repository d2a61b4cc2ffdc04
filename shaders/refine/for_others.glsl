// The number of other rigs that a pass compares with.
#ifndef OTHERS
#define OTHERS 3
#endif

// Expands X(0), X(1), ... for every other rig, since arrays of samplers take constant indices only.
#if OTHERS == 0
#define FOR_OTHERS(X)
#elif OTHERS == 1
#define FOR_OTHERS(X) X(0)
#elif OTHERS == 2
#define FOR_OTHERS(X) X(0) X(1)
#else
#define FOR_OTHERS(X) X(0) X(1) X(2)
#endif
