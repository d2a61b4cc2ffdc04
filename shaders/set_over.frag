// What a rig sees at this instant: its performers before its set.
#include "set_now.glsl"

uniform sampler2D performers;  // depth, metres, 0 = none
uniform sampler2D matte;       // the performers' share

layout(location = 0) out float depth_m;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    depth_m = set_depth_m(at);
    float performer_m = texelFetch(performers, at, 0).r;
    if (performer_m != 0.0 && textureLod(matte, gl_FragCoord.xy / vec2(textureSize(model, 0)), 0.0).r >= 0.5)
        depth_m = performer_m;
}
