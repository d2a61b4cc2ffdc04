// The view that rays of a light field were added up for.
uniform sampler2D sum;  // colour times weight, and weight

layout(location = 0) out vec4 colour;  // alpha 0: no camera has the ray
layout(location = 1) out float z;

void main() {
    vec4 s = texelFetch(sum, ivec2(gl_FragCoord.xy), 0);
    colour = s.a > 0.0 ? vec4(s.rgb / s.a, 1.0) : vec4(0.0);
    z = s.a > 0.0 ? 1.0 : 0.0;
}
