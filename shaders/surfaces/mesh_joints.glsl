// The edge filter: which neighbouring pixels of a depth map lie on one surface.
#ifndef MAX_SLOPE
#define MAX_SLOPE 3.0  // times the tolerance: a step that is always an edge
#endif

uniform sampler2D depth_map;  // metres, 0 = unknown, negative = inpainted
uniform float tolerance;      // of a bend of inverse depth, as a share of the inverse depth

float inverse_depth(ivec2 at, ivec2 size) {
    float z = abs(texelFetch(depth_map, clamp(at, ivec2(0), size - 1), 0).r);
    return z > 0.0 ? 1.0 / z : 0.0;
}

// Whether two neighbours lie on one surface: their step is small, or it continues the slope on one side, as on a slanted
// plane, whose inverse depth is linear in the picture. `before` and `after` are the next pixels outward.
bool joined(float before, float a, float b, float after) {
    if (a <= 0.0 || b <= 0.0) return false;
    float scale = tolerance * max(a, b);
    float jump = b - a;
    float bend = abs(jump);
    if (before > 0.0) bend = min(bend, abs(jump - (a - before)));
    if (after > 0.0) bend = min(bend, abs(jump - (after - b)));
    return bend <= scale && abs(jump) <= MAX_SLOPE * scale;
}

// A quad of the grid, from its upper left pixel: the inverse depths of its corners, and which neighbours are connected.
struct Quad {
    float a, b, c, d;     // upper left, upper right, lower left, lower right
    bool ab, cd, ac, bd;
};

Quad quad_at(ivec2 at, int width, ivec2 size) {
    Quad q;
    q.a = inverse_depth(at, size);
    q.b = inverse_depth(at + width * ivec2(1, 0), size);
    q.c = inverse_depth(at + width * ivec2(0, 1), size);
    q.d = inverse_depth(at + width * ivec2(1, 1), size);
    q.ab = joined(inverse_depth(at + width * ivec2(-1, 0), size), q.a, q.b, inverse_depth(at + width * ivec2(2, 0), size));
    q.cd = joined(inverse_depth(at + width * ivec2(-1, 1), size), q.c, q.d, inverse_depth(at + width * ivec2(2, 1), size));
    q.ac = joined(inverse_depth(at + width * ivec2(0, -1), size), q.a, q.c, inverse_depth(at + width * ivec2(0, 2), size));
    q.bd = joined(inverse_depth(at + width * ivec2(1, -1), size), q.b, q.d, inverse_depth(at + width * ivec2(1, 2), size));
    return q;
}
