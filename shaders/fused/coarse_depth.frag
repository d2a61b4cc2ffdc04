// The inverse of the nearest depth in every cell of a grid over an image; at an edge that of the nearer surface.
uniform sampler2D depth_m;  // its magnitude counts; 0 = nothing
uniform ivec2 cells;        // columns and rows of the grid

layout(location = 0) out float inverse_depth;  // 1/m; 0 = nothing

void main() {
    ivec2 size = textureSize(depth_m, 0);
    ivec2 cell = ivec2(gl_FragCoord.xy);
    ivec2 first = cell * size / cells, last = ((cell + 1) * size - 1) / cells;
    float near = 1e9;
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
            float z = abs(texelFetch(depth_m, ivec2(x, y), 0).r);
            if (z > 0.0) near = min(near, z);
        }
    inverse_depth = near < 1e9 ? 1.0 / near : 0.0;
}
