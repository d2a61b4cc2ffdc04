// Averages 2 x 2 samples: between four texels a linear filter weighs them alike.
uniform sampler2D samples;

layout(location = 0) out vec4 colour;

void main() { colour = texture(samples, 2.0 * gl_FragCoord.xy / vec2(textureSize(samples, 0))); }
