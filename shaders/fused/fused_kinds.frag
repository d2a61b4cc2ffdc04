// Tells the virtual view's pixels apart by what it takes to colour them: depths for a test that fused_colour.frag's
// passes are drawn with.
#include "fused_around.glsl"

uniform float inner_kind;  // within a surface
uniform float edge_kind;   // beside a depth edge
uniform float empty_kind;  // nothing there

void main() {
    Around a = look_around(ivec2(gl_FragCoord.xy));
    gl_FragDepth = a.other != 0.0 ? edge_kind : a.own != 0.0 ? inner_kind : empty_kind;
}
