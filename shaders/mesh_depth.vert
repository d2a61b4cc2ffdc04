// A vertex a pixel of the depth map, displaced by its depth.
uniform sampler2D depth_map;  // metres, 0 = unknown, negative = guessed
uniform mat4 clip_from_pixel; // on (u * z, v * z, z, 1)

void main() {
    int width = textureSize(depth_map, 0).x;
    ivec2 at = ivec2(gl_VertexID % width, gl_VertexID / width);
    float z = abs(texelFetch(depth_map, at, 0).r);
    gl_Position = clip_from_pixel * vec4(vec2(at) * z, z, 1.0);
}
