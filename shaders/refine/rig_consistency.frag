// Compares a rig's depth with the depths of the other rigs, at every other pixel. Red: another rig has its surface so
// exactly here that nothing is to be gained. Alpha: another rig has its surface within same_place_share. Green: a rig
// sees through to a farther surface, and none has its surface here. Blue: the place is in the picture of another rig.
// The means over the map tell how much refinement can gain, and whether the map is to be believed where no other rig
// can check it.
#include "rig_others.glsl"

uniform float exact;  // relative difference of depth that does not show

layout(location = 0) out vec4 consistency;

void compare(int i, sampler2D map, vec2 pixel, float z) {
    vec2 uv;
    float other_z;
    if (!project(i, pixel, z, uv, other_z)) return;
    consistency.b = 1.0;
    vec4 off = textureGather(map, uv) / other_z - 1.0;
    float least = min(min(off.x, off.y), min(off.z, off.w)), most = max(max(off.x, off.y), max(off.z, off.w));
    float away = max(max(least, -most), 0.0);
    if (away < same_place_share) consistency.ra = vec2(max(consistency.r, step(away, exact)), 1.0);
    if (least > same_place_share) consistency.g = 1.0;
}

void main() {
    ivec2 at = min(2 * ivec2(gl_FragCoord.xy), textureSize(depth_map, 0) - 1);
    consistency = vec4(0.0);
    float z = texelFetch(depth_map, at, 0).r;
    if (z <= 0.0) return;
#define COMPARE(i) compare(i, other_depth[i], vec2(at), z);
    FOR_OTHERS(COMPARE)
    consistency.g *= 1.0 - consistency.a;
}
