// Copies a texture to one of the same size; channels that the target lacks are dropped.
uniform sampler2D source;

layout(location = 0) out vec4 copied;

void main() { copied = texelFetch(source, ivec2(gl_FragCoord.xy), 0); }
