// Halves a depth map with holes: the mean inverse depth of the farther ones among the known pixels of a window.
uniform sampler2D depth_map;  // metres, 0 = unknown, negative = inpainted

layout(location = 0) out float half_depth;

// Pixels that the window reaches past the four that become one, so that the far side of a hole prevails.
const int reach = 1;

void main() {
    ivec2 size = textureSize(depth_map, 0);
    ivec2 at = 2 * ivec2(gl_FragCoord.xy);
    float farthest = 0.0;
    for (int y = -reach; y <= 1 + reach; ++y)
        for (int x = -reach; x <= 1 + reach; ++x)
            farthest = max(farthest, texelFetch(depth_map, clamp(at + ivec2(x, y), ivec2(0), size - 1), 0).r);
    float count = 0.0, sum = 0.0;
    for (int y = -reach; y <= 1 + reach; ++y)
        for (int x = -reach; x <= 1 + reach; ++x) {
            float z = texelFetch(depth_map, clamp(at + ivec2(x, y), ivec2(0), size - 1), 0).r;
            if (z > 0.0 && z >= 0.95 * farthest) {
                count += 1.0;
                sum += 1.0 / z;
            }
        }
    half_depth = count > 0.0 ? count / sum : 0.0;
}
