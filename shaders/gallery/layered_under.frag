// What the two nearest rigs do not see, as the next two do: behind what hides it, and before what they see past it.
uniform sampler2D colour;        // of the nearest; alpha 0: nothing, below a half: guessed
uniform sampler2D depth_m;
uniform sampler2D next_colour;
uniform sampler2D next_depth_m;

const float before = 0.97;  // a surface nearer than this share of another's depth stands before it

layout(location = 0) out vec4 both;
layout(location = 1) out float both_m;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 own = texelFetch(colour, at, 0), next = texelFetch(next_colour, at, 0);
    float own_m = texelFetch(depth_m, at, 0).r, next_m = texelFetch(next_depth_m, at, 0).r;
    bool takes_next = own.a < 0.5 ? next.a > own.a : next.a >= 0.5 && next_m < before * own_m;
    both = takes_next ? next : own;
    both_m = takes_next ? next_m : own_m;
}
