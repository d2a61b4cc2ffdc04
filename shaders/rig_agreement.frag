// Whether the other rigs have their surfaces just where this one has its own. Red: they have, so exactly that nothing
// is to be gained; alpha: they have, within what is taken for the same place. Their means over the map say how far
// this rig's depth can be bettered at all.
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
    vec4 off = textureGather(map, uv) / q.z - 1.0;
    float least = min(min(off.x, off.y), min(off.z, off.w)), most = max(max(off.x, off.y), max(off.z, off.w));
    float away = max(max(least, -most), 0.0);
    if (away < same_place) agreement = vec4(max(agreement.r, step(away, exact)), 0.0, 0.0, 1.0);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    agreement = vec4(0.0);
    float z = texelFetch(depth_map, at, 0).r;
    if (z <= 0.0) return;
#define COMPARE(i) compare(i, other_depth[i], vec2(at), z);
    FOR_OTHERS(COMPARE)
}
