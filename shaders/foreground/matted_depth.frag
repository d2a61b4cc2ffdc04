// Depth outside a matte is put behind all depth inside one, so that it hides no other foreground.
uniform sampler2D depth_map;  // metres, 0 = unknown, negative = beyond the matte

in vec2 place_px;  // of the depth map

void main() {
    bool is_inside = texelFetch(depth_map, ivec2(place_px + 0.5), 0).r > 0.0;
    gl_FragDepth = 0.5 * gl_FragCoord.z + (is_inside ? 0.0 : 0.5);
}
