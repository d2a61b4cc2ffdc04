// The colour of the virtual view on the surface of fused_depth.frag at low cost (an unstructured lumigraph: Buehler et al.,
// 2001). Depth edges are as hard as in the depth maps.
#ifndef LAYERS
#define LAYERS 2
#endif
#include "plain_blend.glsl"

uniform sampler2D fused_depth;  // metres, 0 = nothing, negative = inpainted

layout(location = 0) out vec4 fused;
layout(location = 1) out float fused_z;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float own = texelFetch(fused_depth, at, 0).r, z = abs(own);
    fused = vec4(0.0);
    fused_z = 0.0;
    tell_origins(vec4(0.0));
    if (z == 0.0) return;
    Blend blend = Blend(vec3(0.0), vec4(0.0), 0.0, 0.0);
#define ADD(i) add(i, colour[i], source_depth[i], vec2(at), z, 1.0, blend);
    FOR_LAYERS(ADD)
    if (blend.weight == 0.0) return;
    fused = vec4(blend.sum / blend.weight, alpha_of(own > 0.0, blend.confidence));
    fused_z = z;
    tell_origins(blend.shares / blend.weight);
}
