// Two eyes' pictures in turn, row by row, for displays whose rows are polarised; the left eye's first.
uniform sampler2D left;   // of half the height
uniform sampler2D right;

layout(location = 0) out vec4 interleaved;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), of_eye = ivec2(at.x, at.y / 2);
    interleaved = (at.y & 1) == 0 ? texelFetch(left, of_eye, 0) : texelFetch(right, of_eye, 0);
}
