// Where each pixel's line of sight meets a rig's relief, by search in its depth map (Policarpo et al., 2005): even steps
// along the line until it is behind the surface, then halvings.
uniform sampler2D depth_map;     // metres, 0 = unknown, negative = guessed
uniform mat4 pixel_from_target;  // the depth map's (u * z, v * z, z, 1) from the virtual camera's
uniform vec2 range_m;            // from and to which depth the line is followed
uniform float near_m;            // depth buffers hold 1 - near / z
uniform float edge_ratio;        // two depths whose ratio is larger lie on two surfaces

const int most_steps = 512;
const float step_px = 1.0;
const int halvings = 6;
const float passed = 1.005;      // depth over the surface's, from which on a line has gone by behind its edge

// Depth of the surface at a place between pixels; what lies on several surfaces is not mixed.
float surface_at(vec2 place) {
    ivec2 size = textureSize(depth_map, 0), first = ivec2(floor(place));
    float z[4], nearest = 1e30, farthest = 0.0;
    for (int k = 0; k < 4; ++k) {
        z[k] = abs(texelFetch(depth_map, clamp(first + ivec2(k & 1, k >> 1), ivec2(0), size - 1), 0).r);
        nearest = min(nearest, z[k]);
        farthest = max(farthest, z[k]);
    }
    vec2 t = place - vec2(first);
    if (nearest <= 0.0 || farthest > edge_ratio * nearest) return z[(t.x < 0.5 ? 0 : 1) + (t.y < 0.5 ? 0 : 2)];
    return mix(mix(z[0], z[1], t.x), mix(z[2], z[3], t.x), t.y);
}

// The line's depth over the surface's from the rig; 0 where it is before it, or nothing is known.
float depth_behind(vec2 pixel, float inverse_m, bool between) {
    float z = 1.0 / inverse_m;
    vec4 q = pixel_from_target * vec4(pixel * z, z, 1.0);
    vec2 at = q.xy / q.z, size = vec2(textureSize(depth_map, 0));
    if (q.z <= 0.0 || any(lessThan(at, vec2(-0.5))) || any(greaterThan(at, size - 0.5))) return 0.0;
    float surface = between ? surface_at(at) : abs(texelFetch(depth_map, ivec2(min(at + 0.5, size - 1.0)), 0).r);
    return surface > 0.0 && q.z > surface ? q.z / surface : 0.0;
}

void main() {
    vec2 pixel = gl_FragCoord.xy - 0.5;
    gl_FragDepth = 1.0;
    vec4 a = pixel_from_target * vec4(pixel * range_m.x, range_m.x, 1.0);
    vec4 b = pixel_from_target * vec4(pixel * range_m.y, range_m.y, 1.0);
    float length_px = a.z > 0.0 && b.z > 0.0 ? length(a.xy / a.z - b.xy / b.z) : float(most_steps);
    int steps = clamp(int(ceil(length_px / step_px)), 16, most_steps);
    float from = 1.0 / range_m.x, by = (1.0 / range_m.y - from) / float(steps);
    bool was_behind = depth_behind(pixel, from, false) > 0.0;
    for (int k = 1; k <= steps; ++k) {
        float here = from + float(k) * by;
        bool is_behind = depth_behind(pixel, here, false) > 0.0;
        if (is_behind && !was_behind) {
            // A pixel's own depth is no surface between pixels: a step more on both sides.
            float before = here - 2.0 * by;
            here += by;
            for (int h = 0; h < halvings; ++h) {
                float middle = 0.5 * (here + before);
                if (depth_behind(pixel, middle, true) > 0.0)
                    here = middle;
                else
                    before = middle;
            }
            if (depth_behind(pixel, here, true) < passed) {
                gl_FragDepth = 1.0 - near_m * here;
                return;
            }
            here = from + float(k) * by;
        }
        was_behind = is_behind;
    }
}
