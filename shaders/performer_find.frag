// Where performers may stand in the virtual view: the first stage of performer_show.frag, which leaves the set as it is
// elsewhere.
#ifndef LAYERS
#define LAYERS 2
#endif
#define FIRST 1
#include "rig_layers.glsl"
#include "two_stages.glsl"

uniform sampler2D picture;    // of the set
uniform sampler2D set_depth;  // of the view, metres, 0 = nothing, negative = guessed
#if ORIGINS
uniform sampler2D set_shares;
#endif

layout(location = 0) out vec4 shown;
layout(location = 1) out float shown_z;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    shown = texelFetch(picture, at, 0);
    shown_z = abs(texelFetch(set_depth, at, 0).r);
#if ORIGINS
    tell_origins(texelFetch(set_shares, at, 0));
#endif
    bool has_performer = false;
#define FIND(i) has_performer = has_performer || texelFetch(layer_depth[i], at, 0).r < 1.0;
    FOR_LAYERS(FIND)
    leave_to_second(has_performer);
}
