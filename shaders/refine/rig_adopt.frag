// Gives pixels whose depth no other rig confirms the depth of confirmed pixels around them, where the rigs' pictures
// agree far better on that: what is hidden from one of a rig's two cameras, and what its matcher took for something
// else, mostly belongs to a surface beside it. What has no such neighbour, and looks otherwise to the rigs that see it,
// is left as a guess (negative).
#include "rig_others.glsl"

#ifndef RINGS
#define RINGS 4  // of eight neighbours each, 1.4 px away and twice as far from one ring to the next
#endif
#ifndef MOST_DEPTHS
#define MOST_DEPTHS 4  // to choose among
#endif

uniform sampler2D judged;  // from rig_carve.frag
uniform float softness;    // relative depth within which two surfaces are one

layout(location = 0) out float adopted;

const float window_px = 1.0;     // from the middle to the sides of what is compared
const float like_colour = 0.1;   // mean difference (0..1) at which a pixel's weight is 1/e
// Mean colour differences (0..1): what shows one surface at most, what shows two at least, and beyond which nothing is
// more unlike. A neighbour's depth has to leave less than this share of the difference so far.
const float good = 0.08, bad = 0.09, max_cost = 0.15, better = 0.6;
const float same_depth = 0.008;  // relative difference of two that need not both be tried
const float unseen = 1.0;

vec3 window[5];    // this rig's picture around the pixel
float weights[5];  // how far its pixels are of the middle's surface, by their colours; their sum is 1

vec2 aside(int k) { return window_px * vec2(int(k == 1) - int(k == 2), int(k == 3) - int(k == 4)); }

// Adds how unlike another rig's picture is if the pixel's depth is z, and 1, unless that rig cannot see the place.
void look(int i, sampler2D map, sampler2D colours, vec2 pixel, float z, inout vec2 sum) {
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
    for (int k = 0; k < 5; ++k) {
        vec4 p = other_from_pixel[i] * vec4((pixel + aside(k)) * z, z, 1.0);
        vec3 off = abs(textureLod(colours, (p.xy / p.z + 0.5) * texel, 0.0).rgb - window[k]);
        cost += weights[k] * min(dot(off, vec3(1.0 / 3.0)), max_cost);
    }
    sum += vec2(cost, 1.0);
}

float cost_at(vec2 pixel, float z) {
    vec2 sum = vec2(0.0);
#define LOOK(i) look(i, other_depth[i], other_colour[i], pixel, z, sum);
    FOR_OTHERS(LOOK)
    return sum.y > 0.0 ? sum.x / sum.y : unseen;
}

void look_around(vec2 pixel) {
    vec2 texel = 1.0 / vec2(textureSize(judged, 0));
    float sum = 0.0;
    for (int k = 0; k < 5; ++k) window[k] = textureLod(picture, (pixel + 0.5 + aside(k)) * texel, 0.0).rgb;
    for (int k = 0; k < 5; ++k) {
        weights[k] = exp(-dot(abs(window[k] - window[0]), vec3(1.0 / 3.0)) / like_colour);
        sum += weights[k];
    }
    for (int k = 0; k < 5; ++k) weights[k] /= sum;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(judged, 0) - 1;
    vec2 own = texelFetch(judged, at, 0).rg;
    adopted = own.r;
    if (own.g != 0.0) return;
#ifdef WITHOUT_ADOPTION  // tests/bench/step_worth.py
    return;
#endif
    vec2 pixel = vec2(at);
    look_around(pixel);
    float so_far = own.r > 0.0 ? cost_at(pixel, own.r) : unseen;
    // The depths around that differ, the nearest pixels' first.
    float depths[MOST_DEPTHS];
    int count = 0;
    for (int k = 0; k < 8 * RINGS && count < MOST_DEPTHS; ++k) {
        int ring = k / 8;
        float angle = 0.785398 * (float(k) + 0.5 * float(ring & 1));
        vec2 there = exp2(float(ring) + 0.5) * vec2(cos(angle), sin(angle));
        vec2 neighbour = texelFetch(judged, clamp(at + ivec2(round(there)), ivec2(0), last), 0).rg;
        float z = neighbour.r;
        bool is_new = neighbour.g > 0.0 && abs(z - own.r) > same_depth * z;
        for (int c = 0; c < count; ++c) is_new = is_new && abs(z - depths[c]) > same_depth * z;
        if (is_new) depths[count++] = z;
    }
    float least = min(good, better * min(so_far, max_cost));
    for (int c = 0; c < count; ++c) {
        float cost = cost_at(pixel, depths[c]);
        if (cost < least) least = cost, adopted = depths[c];
    }
    if (adopted == own.r && so_far > bad && so_far < unseen) adopted = -own.r;
}
