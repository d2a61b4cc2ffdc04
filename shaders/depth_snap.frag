// Moves depth edges to where the colours change: a pixel close to an edge belongs to the surface, nearer or farther,
// whose colours a little way off it resembles. Depth from matching (and many a truth) is a pixel or two off there.
#ifndef REACH
#define REACH 5
#endif
uniform sampler2D depth_map;  // metres, 0 = unknown, negative = guessed
uniform sampler2D near_far;   // of the neighbourhood (depth_range.frag)
uniform sampler2D colour;
uniform float edge_ratio;     // two depths whose ratio is larger lie on two surfaces

layout(location = 0) out float snapped;

const float distance_cost = 0.0004;  // of a pixel's squared distance, against squared colour difference
const float change_cost = 0.004;

bool is_edge(vec2 range) { return range.y > range.x * edge_ratio; }

void main() {
    ivec2 size = textureSize(depth_map, 0);
    ivec2 at = ivec2(gl_FragCoord.xy);
    float own = texelFetch(depth_map, at, 0).r;
    vec2 range = texelFetch(near_far, at, 0).rg;
    snapped = own;
    if (own == 0.0 || !is_edge(range)) return;
    float split = sqrt(range.x * range.y);
    vec3 c = textureLod(colour, (vec2(at) + 0.5) / vec2(size), 0.0).rgb;
    float best_near = 1e30, best_far = 1e30, near_z = 0.0, far_z = 0.0;
    for (int y = -REACH; y <= REACH; ++y)
        for (int x = -REACH; x <= REACH; ++x) {
            ivec2 there = clamp(at + ivec2(x, y), ivec2(0), size - 1);
            float z = texelFetch(depth_map, there, 0).r;
            if (z == 0.0 || is_edge(texelFetch(near_far, there, 0).rg)) continue;
            vec3 difference = textureLod(colour, (vec2(there) + 0.5) / vec2(size), 0.0).rgb - c;
            float cost = dot(difference, difference) + distance_cost * float(x * x + y * y);
            if (abs(z) < split) {
                if (cost < best_near) {
                    best_near = cost;
                    near_z = z;
                }
            } else if (cost < best_far) {
                best_far = cost;
                far_z = z;
            }
        }
    if (near_z == 0.0 || far_z == 0.0) return;
    bool is_near = abs(own) < split;
    bool to_near = best_near + (is_near ? 0.0 : change_cost) < best_far + (is_near ? change_cost : 0.0);
    if (to_near != is_near) snapped = to_near ? near_z : far_z;
}
