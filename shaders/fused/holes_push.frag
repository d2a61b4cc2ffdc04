// Keeps known pixels and fills holes from the image of half the size.
uniform sampler2D known;   // alpha 0 = hole
uniform sampler2D coarse;
uniform float filled_alpha;

layout(location = 0) out vec4 filled;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 here = texelFetch(known, at, 0);
    if (here.a > 0.0) {
        filled = here;
        return;
    }
    vec4 there = textureLod(coarse, (0.5 * vec2(at) + 0.25) / vec2(textureSize(coarse, 0)), 0.0);
    filled = vec4(there.rgb, there.a > 0.5 ? filled_alpha : 0.0);
}
