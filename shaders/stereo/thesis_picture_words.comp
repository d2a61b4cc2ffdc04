// Copies an rgba8 texture into a storage buffer, a word a pixel: every later pass reads each pixel
// several times, and a buffer is the cheaper place to read from.
#ifndef GROUP_WIDTH
#define GROUP_WIDTH 64
#endif
layout(local_size_x = GROUP_WIDTH) in;
layout(std430, binding = 0) writeonly buffer Words { uint words[]; };
uniform sampler2D picture;
uniform ivec2 size;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= size.x) return;
    words[at.y * size.x + at.x] = packUnorm4x8(texelFetch(picture, at, 0));
}
