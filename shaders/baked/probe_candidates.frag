// The rigs' surfaces in a probe's view: metres, a channel per rig, 0 = none.
#include "rig_layers.glsl"

layout(location = 0) out vec4 candidates_m;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    candidates_m = vec4(0.0);
#define LOOK(i)                                   \
    {                                             \
        float z = layer_z(layer_depth[i], at);    \
        if (z < nothing) candidates_m[i] = z;     \
    }
    FOR_LAYERS(LOOK)
}
