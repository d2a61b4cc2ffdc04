// Splits a rig's picture in two layers at depth edges, after Zitnick et al. (2004): the main layer goes on behind the
// edge with the farther surface; the boundary layer is a strip of the nearer one with a matte, how much of every pixel
// it fills.
#ifndef BOUNDARY
#define BOUNDARY 0  // 1: the boundary layer
#endif
#ifndef DEPTH
#define DEPTH 0     // 1: the layer's depth, else its colour
#endif

uniform sampler2D picture;
uniform sampler2D depth_map;  // metres, 0 = unknown, negative = guessed; of the picture's size or smaller
uniform float edge_ratio;     // two depths whose ratio is larger lie on two surfaces

#if DEPTH
layout(location = 0) out float layer_z;  // metres, 0 = nothing
#else
layout(location = 0) out vec4 layer_colour;  // alpha: the matte; of the main layer how much of the pixel shows it
#endif

const int reach = 1;             // px from an edge to which lens and sensor mix colours; a wider strip guesses more than it mends
const float blur_px = 0.65;      // standard deviation of that mixing
const float nearness_px = 1.5;   // of the pixels that tell the pure colours
const float least_shown = 0.02;  // what goes on behind the edge is guessed, and better than nothing
const float area_worth = 0.05;   // of the areas' word on the matte, against a squared colour contrast

float depth_at(ivec2 at, ivec2 size) {
    ivec2 map = textureSize(depth_map, 0);
    ivec2 there = ivec2((vec2(at) + 0.5) * vec2(map) / vec2(size));
    return abs(texelFetch(depth_map, clamp(there, ivec2(0), map - 1), 0).r);
}

bool same_surface(float a, float b) { return a == b || max(a, b) < min(a, b) * edge_ratio; }

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
#if DEPTH
    ivec2 size = textureSize(depth_map, 0);
#else
    ivec2 size = textureSize(picture, 0);
    vec3 c = texelFetch(picture, at, 0).rgb;
#endif
    float own = depth_at(at, size), other = 0.0, nearest = 1e9;
    // One pixel more on the near side of the boundary layer, to overlap the main one.
    int wide = reach + BOUNDARY;
    for (int y = -wide; y <= wide; ++y)
        for (int x = -wide; x <= wide; ++x) {
            float z = depth_at(at + ivec2(x, y), size), away = float(x * x + y * y);
            if (z <= 0.0 || away >= nearest || same_surface(z, own)) continue;
            if (z < own && max(abs(x), abs(y)) > reach) continue;
            other = z;
            nearest = away;
        }
    bool in_strip = own > 0.0 && other > 0.0;
    float near = min(own, other), far = max(own, other);
#if DEPTH
#if BOUNDARY
    layer_z = in_strip ? near : 0.0;
#else
    layer_z = in_strip ? far : own;
#endif
#else
    if (!in_strip) {
        layer_colour = vec4(c, BOUNDARY == 1 ? 0.0 : 1.0);
        return;
    }
    vec4 front = vec4(0.0), back = vec4(0.0);
    float area = 0.0, all = 0.0;
    for (int y = -reach - 2; y <= reach + 2; ++y)
        for (int x = -reach - 2; x <= reach + 2; ++x) {
            ivec2 to = clamp(at + ivec2(x, y), ivec2(0), size - 1);
            float z = depth_at(to, size), away = float(x * x + y * y);
            bool is_near = same_surface(z, near), is_far = same_surface(z, far);
            float mixed = exp(-away / (2.0 * blur_px * blur_px));
            all += is_near || is_far ? mixed : 0.0;
            area += is_near ? mixed : 0.0;
            // A pixel whose four neighbours lie on its surface shows it alone.
            float pure = 0.02;
            if (same_surface(depth_at(to + ivec2(1, 0), size), z) && same_surface(depth_at(to - ivec2(1, 0), size), z) &&
                same_surface(depth_at(to + ivec2(0, 1), size), z) && same_surface(depth_at(to - ivec2(0, 1), size), z))
                pure = 1.0;
            vec4 seen = pure * exp(-away / (2.0 * nearness_px * nearness_px)) * vec4(texelFetch(picture, to, 0).rgb, 1.0);
            if (is_near)
                front += seen;
            else if (is_far)
                back += seen;
        }
    vec3 f = front.a > 0.0 ? front.rgb / front.a : c, b = back.a > 0.0 ? back.rgb / back.a : c;
    vec3 contrast = f - b;
    float told = dot(contrast, contrast);
    float by_colour = told > 0.0 ? clamp(dot(c - b, contrast) / told, 0.0, 1.0) : 0.0;
    float share = (area_worth * area / max(all, 1e-6) + told * by_colour) / (area_worth + told);
#if BOUNDARY
    layer_colour = vec4(mix(f, c, smoothstep(0.6, 1.0, share)), share);
#else
    layer_colour = vec4(mix(c, b, smoothstep(0.0, 0.4, share)), max(1.0 - share, least_shown));
#endif
#endif
}
