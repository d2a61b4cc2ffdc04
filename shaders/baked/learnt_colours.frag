// The learnt colours of a rig's background. Alpha is their confidence: lower beside depth edges.
uniform sampler2D background_colour;  // from background_colour.frag
uniform sampler2D confidence;         // from edge_confidence.frag

layout(location = 0) out vec4 colour;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    colour = vec4(texelFetch(background_colour, at, 0).rgb, max(texelFetch(confidence, at, 0).r, 1.0 / 255.0));
}
