// Takes the stage's floor for the surface of a pixel where the other rigs' pictures speak as well for it as for the
// pixel's own depth. A plain floor looks the same at every depth, and a matcher takes it for what stands on it.
#include "rig_others.glsl"

uniform sampler2D before;  // metres, 0 = unknown, negative = guessed
uniform vec3 floor_plane;  // inverse depth per (u, v, 1) of the depth map
uniform float softness;    // relative depth within which two surfaces are one

layout(location = 0) out float with_floor;

const float window_px = 1.5;     // from the middle to the sides of what is compared
const float like_colour = 0.1;   // mean difference (0..1) at which a pixel's weight is 1/e
// Mean colour differences (0..1): beyond which nothing is more unlike, by which the floor may be more unlike than the
// pixel's own depth, and what may be the floor though that depth is far from it.
const float max_cost = 0.15, grace = 0.01, alike = 0.06;
const float near = 2.0;          // deviations of a measured depth

vec3 window[9];    // this rig's picture around the pixel
float weights[9];  // how far its pixels are of the middle's surface, by their colours; their sum is 1

vec2 aside(int k) { return window_px * vec2(k % 3 - 1, k / 3 - 1); }

void look_around(vec2 pixel) {
    vec2 texel = 1.0 / vec2(textureSize(depth_map, 0));
    float sum = 0.0;
    for (int k = 0; k < 9; ++k) window[k] = textureLod(picture, (pixel + 0.5 + aside(k)) * texel, 0.0).rgb;
    for (int k = 0; k < 9; ++k) {
        weights[k] = exp(-dot(abs(window[k] - window[4]), vec3(1.0 / 3.0)) / like_colour);
        sum += weights[k];
    }
    for (int k = 0; k < 9; ++k) weights[k] /= sum;
}

// Adds how unlike another rig's picture is if the pixels around lie on a plane, and 1, unless that rig cannot see it.
void look(int i, sampler2D map, sampler2D colours, vec2 pixel, vec3 plane, inout vec2 sum) {
    float z = 1.0 / dot(plane, vec3(pixel, 1.0));
    vec4 q = other_from_pixel[i] * vec4(pixel * z, z, 1.0);
    if (q.z <= 0.0) return;
    vec2 texel = 1.0 / other_size[i];
    vec2 uv = (q.xy / q.z + 0.5) * texel;
    vec2 inside = min(uv, 1.0 - uv);
    if (min(inside.x, inside.y) < 0.0) return;
    vec4 there = textureGather(map, uv);
    float tolerance = softness + 4.0 * (other_spread[i] * q.z + spread * z);
    bool is_hidden = all(lessThan(there, vec4(q.z * (1.0 - tolerance)))) && all(greaterThan(there, vec4(0.0)));
    if (is_hidden) return;
    float cost = 0.0;
    for (int k = 0; k < 9; ++k) {
        vec2 at = pixel + aside(k);
        float zk = 1.0 / dot(plane, vec3(at, 1.0));
        vec4 p = other_from_pixel[i] * vec4(at * zk, zk, 1.0);
        vec3 off = abs(textureLod(colours, (p.xy / p.z + 0.5) * texel, 0.0).rgb - window[k]);
        cost += weights[k] * min(dot(off, vec3(1.0 / 3.0)), max_cost);
    }
    sum += vec2(cost, 1.0);
}

// 1 where no other rig sees it.
float cost_on(vec2 pixel, vec3 plane) {
    vec2 sum = vec2(0.0);
#define LOOK(i) look(i, other_depth[i], other_colour[i], pixel, plane, sum);
    FOR_OTHERS(LOOK)
    return sum.y > 0.0 ? sum.x / sum.y : 1.0;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 pixel = vec2(at);
    float own = texelFetch(before, at, 0).r, nearness = dot(floor_plane, vec3(pixel, 1.0));
    with_floor = own;
    const float horizon = 1e-3;
    if (own <= 0.0 || nearness < horizon) return;
#ifdef WITHOUT_FLOOR  // tests/bench/step_worth.py
    return;
#endif
    look_around(pixel);
    float on_floor = cost_on(pixel, floor_plane);
    if (on_floor > alike && abs(nearness - 1.0 / own) > near * spread) return;
    if (on_floor < cost_on(pixel, vec3(0.0, 0.0, 1.0 / own)) + grace) with_floor = 1.0 / nearness;
}
