// How unlike the pictures of the rigs that see a pixel's point are to this one's, at sixteen depths around its own.
#include "rig_others.glsl"

uniform float relative_step;  // of inverse depth, from one to the next
uniform float lod;

layout(location = 0) out vec4 costs[4];

const float same_place = 0.08;  // relative depth within which another rig may see the same point
const float most = 0.15;        // mean colour difference (0..1) beyond which nothing is more unlike

bool sees(int i, sampler2D map, vec2 pixel, float z) {
    vec4 q = other_from_pixel[i] * vec4(pixel * z, z, 1.0);
    if (q.z <= 0.0) return false;
    vec2 uv = (q.xy / q.z + 0.5) / other_size[i];
    vec2 inside = min(uv, 1.0 - uv);
    if (min(inside.x, inside.y) < 0.0) return false;
    vec4 there = textureGather(map, uv) / q.z;
    return any(lessThan(abs(there - 1.0), vec4(same_place)));
}

void look(int i, sampler2D colours, vec3 along, float z, vec3 own, inout vec2 sum) {
    vec3 q = along * z + other_from_pixel[i][3].xyz;
    vec3 d = abs(textureLod(colours, (q.xy / q.z + 0.5) / other_size[i], lod).rgb - own);
    sum += vec2(min(dot(d, vec3(1.0 / 3.0)) / most, 1.0), 1.0);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 pixel = vec2(at);
    float own = texelFetch(depth_map, at, 0).r;
    costs[0] = costs[1] = costs[2] = costs[3] = vec4(0.0);
    if (own <= 0.0) return;
    bool seen[OTHERS], any_seen = false;
    vec3 along[OTHERS];  // the pixel's ray, as the other rig sees it
#define SEES(i) seen[i] = sees(i, other_depth[i], pixel, own); any_seen = any_seen || seen[i]; \
    along[i] = (other_from_pixel[i] * vec4(pixel, 1.0, 0.0)).xyz;
    FOR_OTHERS(SEES)
    if (!any_seen) return;
    vec3 colour = textureLod(picture, (pixel + 0.5) / vec2(textureSize(depth_map, 0)), lod).rgb;
    float cost[16];
    for (int h = 0; h < 16; ++h) {
        float z = own / (1.0 + float(h - 7) * relative_step);
        vec2 sum = vec2(0.0);
#define LOOK(i) if (seen[i]) look(i, other_colour[i], along[i], z, colour, sum);
        FOR_OTHERS(LOOK)
        cost[h] = sum.x / sum.y;
    }
    costs[0] = vec4(cost[0], cost[1], cost[2], cost[3]);
    costs[1] = vec4(cost[4], cost[5], cost[6], cost[7]);
    costs[2] = vec4(cost[8], cost[9], cost[10], cost[11]);
    costs[3] = vec4(cost[12], cost[13], cost[14], cost[15]);
}
