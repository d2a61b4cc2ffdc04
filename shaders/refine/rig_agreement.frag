// How the other rigs' depths compare with this one's, for every other pixel. Red: a rig has its surface just here, so
// exactly that nothing is to be gained; alpha: here, within what is taken for the same place. Green: a rig sees through
// to a farther surface, and none has one here; blue: in the picture of another rig. Their means over the map say how
// far this rig's depth can be bettered, and how far it is to be trusted where no other rig can tell.
#include "rig_others.glsl"

uniform float exact;  // relative difference of depth that does not show

layout(location = 0) out vec4 agreement;

const float same_place = 0.05;  // relative depth

void compare(int i, sampler2D map, vec2 pixel, float z) {
    vec4 q = other_from_pixel[i] * vec4(pixel * z, z, 1.0);
    if (q.z <= 0.0) return;
    vec2 uv = (q.xy / q.z + 0.5) / other_size[i];
    vec2 inside = min(uv, 1.0 - uv);
    if (min(inside.x, inside.y) < 0.0) return;
    agreement.b = 1.0;
    vec4 off = textureGather(map, uv) / q.z - 1.0;
    float least = min(min(off.x, off.y), min(off.z, off.w)), most = max(max(off.x, off.y), max(off.z, off.w));
    float away = max(max(least, -most), 0.0);
    if (away < same_place) agreement.ra = vec2(max(agreement.r, step(away, exact)), 1.0);
    if (least > same_place) agreement.g = 1.0;
}

void main() {
    ivec2 at = min(2 * ivec2(gl_FragCoord.xy), textureSize(depth_map, 0) - 1);
    agreement = vec4(0.0);
    float z = texelFetch(depth_map, at, 0).r;
    if (z <= 0.0) return;
#define COMPARE(i) compare(i, other_depth[i], vec2(at), z);
    FOR_OTHERS(COMPARE)
    agreement.g *= 1.0 - agreement.a;
}
