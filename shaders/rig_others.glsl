// What RigConsensus binds: a rig's depth map and the other rigs that look at what it shows.
#ifndef OTHERS
#define OTHERS 3
#endif

uniform sampler2D depth_map;             // this rig's, metres, 0 = unknown
uniform sampler2D picture;               // this rig's
uniform float spread;                    // relative uncertainty of this rig's depth, per metre of depth
uniform sampler2D other_depth[OTHERS];   // metres, 0 = unknown
uniform sampler2D other_colour[OTHERS];
uniform mat4 other_from_pixel[OTHERS];   // the other's (u * z, v * z, z, 1) from this depth map's
uniform vec2 other_size[OTHERS];         // of its picture, px
uniform float other_spread[OTHERS];

// Runs X(0), X(1), ... for every other rig: samplers take constant indices only.
#if OTHERS == 1
#define FOR_OTHERS(X) X(0)
#elif OTHERS == 2
#define FOR_OTHERS(X) X(0) X(1)
#else
#define FOR_OTHERS(X) X(0) X(1) X(2)
#endif
