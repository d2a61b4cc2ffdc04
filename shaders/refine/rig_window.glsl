// The photometric cost of a depth over a window of WINDOW pixels of this rig's picture, compared with other rigs'
// pictures. Define WINDOW and the window's `vec2 aside(int k)`, whose middle is `window_middle`, before the include.
vec3 window[WINDOW];    // this rig's picture around the pixel
float weights[WINDOW];  // how far its pixels belong to the middle's surface, by their colours; their sum is 1

// Reads the window; `size_px` is the size of the map that pixels count in.
void read_window(vec2 pixel, ivec2 size_px) {
    vec2 texel = 1.0 / vec2(size_px);
    float sum = 0.0;
    for (int k = 0; k < WINDOW; ++k) window[k] = textureLod(picture, (pixel + 0.5 + aside(k)) * texel, 0.0).rgb;
    for (int k = 0; k < WINDOW; ++k) {
        weights[k] = colour_weight(window[k], window[window_middle], window_colour_falloff);
        sum += weights[k];
    }
    for (int k = 0; k < WINDOW; ++k) weights[k] /= sum;
}

const float unseen_cost = 1.0;  // of a place that no other rig sees

// Adds (cost, 1) of another rig if the pixels around lie on a plane (inverse depth per (u, v, 1)), unless that rig cannot
// see the place.
void add_cost(int i, sampler2D map, sampler2D colours, vec2 pixel, vec3 plane, inout vec2 sum) {
    float z = 1.0 / dot(plane, vec3(pixel, 1.0)), other_z;
    vec2 uv;
    if (!project(i, pixel, z, uv, other_z) || is_hidden(i, textureGather(map, uv), other_z, z)) return;
    vec2 texel = 1.0 / other_size[i];
    float cost = 0.0;
    for (int k = 0; k < WINDOW; ++k) {
        vec2 at = pixel + aside(k);
        float zk = 1.0 / dot(plane, vec3(at, 1.0));
        vec4 p = other_from_pixel[i] * vec4(at * zk, zk, 1.0);
        vec3 there = textureLod(colours, (p.xy / p.z + 0.5) * texel, 0.0).rgb;
        cost += weights[k] * min(colour_difference(there, window[k]), max_pixel_cost);
    }
    sum += vec2(cost, 1.0);
}

// The mean cost over the other rigs that see the place.
float cost_on(vec2 pixel, vec3 plane) {
    vec2 sum = vec2(0.0);
#define ADD_COST(i) add_cost(i, other_depth[i], other_colour[i], pixel, plane, sum);
    FOR_OTHERS(ADD_COST)
    return sum.y > 0.0 ? sum.x / sum.y : unseen_cost;
}

float cost_at(vec2 pixel, float z) { return cost_on(pixel, vec3(0.0, 0.0, 1.0 / z)); }
