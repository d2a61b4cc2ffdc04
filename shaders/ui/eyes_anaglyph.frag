// Two eyes' pictures as one for red and cyan glasses: of all colours that the glasses let each eye see, the least squares
// nearest to what it should see (E. Dubois, "A projection method to generate anaglyph stereo images", 2001).
uniform sampler2D left;
uniform sampler2D right;

layout(location = 0) out vec4 anaglyph;

// Columns: what red, green and blue of an eye give to red, green and blue.
const mat3 of_left = mat3(0.437, -0.062, -0.048, 0.449, -0.062, -0.050, 0.164, -0.024, -0.017);
const mat3 of_right = mat3(-0.011, 0.377, -0.026, -0.032, 0.761, -0.093, -0.007, 0.009, 1.234);
const float gamma = 2.2;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 l = texelFetch(left, at, 0), r = texelFetch(right, at, 0);
    vec3 light = of_left * pow(l.rgb, vec3(gamma)) + of_right * pow(r.rgb, vec3(gamma));
    anaglyph = vec4(pow(clamp(light, 0.0, 1.0), vec3(1.0 / gamma)), min(l.a, r.a));
}
