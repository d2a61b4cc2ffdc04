// Draws the selected tiles of a target, two triangles each, without vertex data.
uniform sampler2D tiles;   // one pixel for each tile: above 0 where it is drawn
uniform vec2 tile_share;   // share of the target that a tile spans

void main() {
    int tile = gl_VertexID / 6, corner = gl_VertexID % 6, columns = textureSize(tiles, 0).x;
    ivec2 at = ivec2(tile % columns, tile / columns);
    bool is_drawn = texelFetch(tiles, at, 0).r > 0.0;
    // Corners 0 1 2 and 2 1 3, in rows.
    int place = corner < 3 ? corner : corner == 3 ? 2 : corner == 4 ? 1 : 3;
    vec2 uv = (vec2(at) + vec2(place & 1, place >> 1)) * tile_share;
    gl_Position = vec4(is_drawn ? 2.0 * uv - 1.0 : vec2(2.0), 0.0, 1.0);
}
