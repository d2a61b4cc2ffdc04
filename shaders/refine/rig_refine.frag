// Moves every pixel's depth to where the rigs' pictures are most alike around it.
#ifndef REACH
#define REACH 2  // px, of the window whose pixels decide together
#endif

uniform sampler2D depth_map;  // metres, 0 = unknown
uniform sampler2D picture;
uniform sampler2D costs[4];  // of sixteen depths, from rig_sweep.frag
uniform float relative_step;  // of inverse depth, from one to the next
uniform float edge_ratio;     // two depths whose ratio is larger lie on two surfaces

layout(location = 0) out float refined;

const float like_colour = 0.1;  // mean difference (0..1) at which a pixel's weight is 1/e
const float reluctance = 0.01;   // how much more alike a depth must be for every step that it is further
const int stay = 7;              // the step that leaves depth as it is

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), size = textureSize(depth_map, 0);
    float own = texelFetch(depth_map, at, 0).r;
    refined = own;
    if (own <= 0.0) return;
    vec2 texel = 1.0 / vec2(size);
    vec3 colour = textureLod(picture, (vec2(at) + 0.5) * texel, 0.0).rgb;
    vec4 a = vec4(0.0), b = a, c = a, d = a;
    float weights = 0.0;
    // Every other pixel says nearly what all of them do.
    for (int y = -REACH; y <= REACH; y += 2)
        for (int x = -REACH; x <= REACH; x += 2) {
            ivec2 there = clamp(at + ivec2(x, y), ivec2(0), size - 1);
            float z = texelFetch(depth_map, there, 0).r;
            if (max(z, own) > min(z, own) * edge_ratio) continue;
            vec3 off = abs(textureLod(picture, (vec2(there) + 0.5) * texel, 0.0).rgb - colour);
            float w = exp(-dot(off, vec3(1.0 / 3.0)) / like_colour) + 1e-4;
            a += w * texelFetch(costs[0], there, 0);
            b += w * texelFetch(costs[1], there, 0);
            c += w * texelFetch(costs[2], there, 0);
            d += w * texelFetch(costs[3], there, 0);
            weights += w;
        }
    float cost[16] = float[16](a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w, c.x, c.y, c.z, c.w, d.x, d.y, d.z, d.w);
    int best = stay;
    for (int h = 0; h < 16; ++h) {
        cost[h] = cost[h] / weights + reluctance * abs(float(h - stay));
        if (cost[h] < cost[best]) best = h;
    }
    float steps = float(best - stay);
    if (best > 0 && best < 15) {
        float bend = cost[best - 1] + cost[best + 1] - 2.0 * cost[best];
        if (bend > 1e-5) steps += clamp(0.5 * (cost[best - 1] - cost[best + 1]) / bend, -0.5, 0.5);
    }
    refined = own / (1.0 + steps * relative_step);
}
