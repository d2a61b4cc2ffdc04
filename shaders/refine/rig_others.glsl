// What RigConsensus binds: a rig's depth map and the other rigs that look at what it shows.
#include "for_others.glsl"

uniform sampler2D depth_map;             // this rig's, metres, 0 = unknown
uniform sampler2D picture;               // this rig's
uniform float spread;                    // relative uncertainty of this rig's depth, per metre of depth
uniform sampler2D other_depth[OTHERS];   // metres, 0 = unknown
uniform sampler2D other_colour[OTHERS];
uniform mat4 other_from_pixel[OTHERS];   // the other's (u * z, v * z, z, 1) from this depth map's
uniform vec2 other_size[OTHERS];         // of its picture, px
uniform float other_spread[OTHERS];
