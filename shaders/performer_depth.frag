// The depth of what stands before a rig's set: measured where it was, elsewhere that of the pixels around that look
// alike; smoothed within surfaces.
uniform sampler2D depth_map;  // from performer_carve.frag, metres, 0 = unknown
uniform sampler2D picture;
uniform sampler2D matte;      // the performers' share
uniform float edge_ratio;     // two depths whose ratio is larger lie on two surfaces

layout(location = 0) out float performer_m;  // metres, 0 = nothing

const int reach = 3;             // steps to either side
const int step_px = 2;
const float smooth_steps = 0.7;
const float like_colour = 0.06;  // difference (0..1) at which a pixel's weight is 1/e

bool is_measured(ivec2 at) { return texelFetch(depth_map, at, 0).r > 0.0; }

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(depth_map, 0) - 1;
    vec2 texel = 1.0 / vec2(last + 1), uv = (vec2(at) + 0.5) * texel;
    performer_m = 0.0;
    if (textureLod(matte, uv, 0.0).r == 0.0) return;
    vec3 own = textureLod(picture, uv, 0.0).rgb;
    float z = is_measured(at) ? texelFetch(depth_map, at, 0).r : 0.0;
    float best = 0.0;
    float depths[49], weights[49];
    int count = 0;
    for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) {
            ivec2 there = clamp(at + step_px * ivec2(x, y), ivec2(0), last);
            if (!is_measured(there)) continue;
            vec3 off = abs(textureLod(picture, (vec2(there) + 0.5) * texel, 0.0).rgb - own);
            float w = exp(-(off.r + off.g + off.b) / (3.0 * like_colour)) / (1.0 + 0.5 * float(x * x + y * y)) + 1e-5;
            depths[count] = texelFetch(depth_map, there, 0).r;
            weights[count] = w * exp(-0.5 * float(x * x + y * y) / (smooth_steps * smooth_steps));
            ++count;
            if (z == 0.0 && w > best) best = w, performer_m = depths[count - 1];
        }
    if (z > 0.0) performer_m = z;
    if (performer_m == 0.0) return;
    float sum = 0.0, all = 0.0;
    for (int k = 0; k < count; ++k) {
        if (max(depths[k], performer_m) > min(depths[k], performer_m) * edge_ratio) continue;
        sum += weights[k] / depths[k];
        all += weights[k];
    }
    if (all > 0.0) performer_m = all / sum;
}
