// The surfaces of fused_depth.frag around a pixel of the virtual view, inpainted ones included, since they have edges
// too.
uniform sampler2D fused_depth;  // metres, 0 = nothing, negative = inpainted
uniform float edge_ratio;       // two depths whose ratio is larger lie on two surfaces

bool same_surface(float a, float b) { return max(a, b) < min(a, b) * edge_ratio; }

struct Around {
    float z[25];  // of the pixels around, rows of five, 0 = nothing
    float own;    // of the pixel, negative where it is inpainted
    float here;   // the surface that it lies on, 0 = nothing; the nearest pixel's where it has none
    float other;  // the nearest pixel's on another surface, 0 = there is none
};

Around look_around(ivec2 at) {
    ivec2 last = textureSize(fused_depth, 0) - 1;
    Around a;
    a.own = texelFetch(fused_depth, at, 0).r;
    a.here = abs(a.own);
    a.other = 0.0;
    float nearest = 1e9;
    for (int k = 0; k < 25; ++k) {
        ivec2 off = ivec2(k % 5, k / 5) - 2;
        a.z[k] = abs(texelFetch(fused_depth, clamp(at + off, ivec2(0), last), 0).r);
        float away = float(off.x * off.x + off.y * off.y);
        if (a.z[k] <= 0.0 || away >= nearest) continue;
        if (a.here == 0.0) {
            a.here = a.z[k];
            nearest = away;
        }
        if (same_surface(a.z[k], a.here)) continue;
        a.other = a.z[k];
        nearest = away;
    }
    return a;
}
