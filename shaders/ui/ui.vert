// Dear ImGui's triangles. Row 0 of the target is the top of the picture, so y is not turned.
uniform vec2 px_to_clip;  // 2 / size of the target
layout(location = 0) in vec2 position_px;
layout(location = 1) in vec2 texture_position;
layout(location = 2) in vec4 vertex_colour;
out vec2 uv;
out vec4 colour;

void main() {
    uv = texture_position;
    colour = vertex_colour;
    gl_Position = vec4(position_px * px_to_clip - 1.0, 0.0, 1.0);
}
