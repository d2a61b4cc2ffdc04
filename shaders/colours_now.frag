// A rig's colours of this instant: the set's without noise, where it is seen, and the performers' as they are.
uniform sampler2D picture;
uniform sampler2D set_colour;  // from set_colour.frag: alpha is 1 where the set is seen now

layout(location = 0) out vec4 colour;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 set = texelFetch(set_colour, at, 0);
    colour = vec4(set.a == 1.0 ? set.rgb : texelFetch(picture, at, 0).rgb, 1.0);
}
