// Classifies the virtual view's pixels by the work that their colour takes, as depths for the depth test of
// fused_colour.frag's passes.
#include "fused_around.glsl"

uniform float inner_kind;  // inside a surface
uniform float edge_kind;   // beside a depth edge
uniform float empty_kind;  // no surface

void main() {
    Around a = look_around(ivec2(gl_FragCoord.xy));
    gl_FragDepth = a.other != 0.0 ? edge_kind : a.own != 0.0 ? inner_kind : empty_kind;
}
