// Keeps known and inpainted depth, and inpaints the rest, with a negative sign, from the map of half the size.
uniform sampler2D depth_map;  // metres, 0 = unknown, negative = inpainted
uniform sampler2D coarse;     // metres, negative = inpainted

layout(location = 0) out float closed;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float z = texelFetch(depth_map, at, 0).r;
    if (z != 0.0) {
        closed = z;
        return;
    }
    ivec2 size = textureSize(coarse, 0);
    // The four coarse pixels around this one, weighted as in bilinear interpolation.
    ivec2 low = (at + 1) / 2 - 1;
    vec2 part = vec2(at & 1) * -0.5 + 0.75;
    float sum = 0.0, weights = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 corner = ivec2(i & 1, i >> 1);
        float there = abs(texelFetch(coarse, clamp(low + corner, ivec2(0), size - 1), 0).r);
        vec2 w = mix(1.0 - part, part, vec2(corner));
        if (there > 0.0) {
            sum += w.x * w.y / there;
            weights += w.x * w.y;
        }
    }
    closed = weights > 0.0 ? -weights / sum : 0.0;
}
