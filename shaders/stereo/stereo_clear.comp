// Sets every word to all ones.
#include "stereo_common.glsl"

layout(local_size_x = PICTURE_LANES) in;
layout(std430, binding = 0) writeonly buffer Words { uvec4 words[]; };
uniform int count;

void main() {
    int at = int(gl_GlobalInvocationID.x);
    if (at < count) words[at] = uvec4(0xffffffffu);
}
