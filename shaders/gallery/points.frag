flat in vec4 splat_colour;
flat in float splat_z;

layout(location = 0) out vec4 colour;
layout(location = 1) out float z;

void main() {
    colour = splat_colour;
    z = splat_z;
}
