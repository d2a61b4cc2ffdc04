// Glyphs come from a one-channel atlas as coverage; pictures are opaque whatever their alpha tells.
uniform sampler2D image;
uniform int is_glyph;
in vec2 uv;
in vec4 colour;
layout(location = 0) out vec4 fragment;

void main() {
    vec4 texel = texture(image, uv);
    fragment = colour * (is_glyph != 0 ? vec4(1.0, 1.0, 1.0, texel.r) : vec4(texel.rgb, 1.0));
}
