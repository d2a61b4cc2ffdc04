// A rig's background plate: the farthest depth that was steady, and its colour. Alpha counts confirmations. What is
// nearer than a confirmed plate stands before it and changes nothing; what is farther, for as many instants as the
// plate was confirmed, replaces it, so that one wrong depth does not.
uniform sampler2D depth_map;     // this instant's, metres, 0 = unknown
uniform sampler2D picture;
uniform sampler2D plate_depth;   // metres, 0 = nothing learnt
uniform sampler2D plate_colour;  // alpha: confirmations
uniform float edge_ratio;        // two depths whose ratio is larger lie on two surfaces
uniform float has_before;        // 0: there is no plate yet

layout(location = 0) out vec4 learnt_colour;
layout(location = 1) out float learnt_depth;

const float confirmation = 0.25;
const float confirmed = 0.7;
const float share_of_new = 0.3;
const int reach = 2;  // px from a nearer surface within which colours are mixed with its own

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    learnt_depth = has_before > 0.0 ? texelFetch(plate_depth, at, 0).r : 0.0;
    learnt_colour = has_before > 0.0 ? texelFetch(plate_colour, at, 0) : vec4(0.0);
    float z = texelFetch(depth_map, at, 0).r;
    if (z <= 0.0) return;
    ivec2 last = textureSize(depth_map, 0) - 1;
    for (int k = 0; k < 9; ++k) {
        float near = texelFetch(depth_map, clamp(at + reach * (ivec2(k % 3, k / 3) - 1), ivec2(0), last), 0).r;
        if (near > 0.0 && near * edge_ratio < z) return;
    }
    vec3 colour = textureLod(picture, (vec2(at) + 0.5) / vec2(last + 1), 0.0).rgb;
    bool is_same = max(z, learnt_depth) < min(z, learnt_depth) * edge_ratio;
    if (learnt_depth > 0.0 && is_same) {
        learnt_depth = 1.0 / mix(1.0 / learnt_depth, 1.0 / z, share_of_new);
        learnt_colour = vec4(mix(learnt_colour.rgb, colour, share_of_new), min(learnt_colour.a + confirmation, 1.0));
    } else if (z > learnt_depth && learnt_colour.a > confirmation) {
        learnt_colour.a -= confirmation;
    } else if (z > learnt_depth || learnt_colour.a < confirmed) {
        learnt_depth = z;
        learnt_colour = vec4(colour, confirmation);
    }
}
