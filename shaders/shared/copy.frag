// A texture as it is, into one of its size; channels that the target lacks are left out.
uniform sampler2D source;

layout(location = 0) out vec4 copied;

void main() { copied = texelFetch(source, ivec2(gl_FragCoord.xy), 0); }
