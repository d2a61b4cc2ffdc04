// Converts a rig's disparities to metres by a table of all values. The CPU reference is
// DisparityScale::depth_m.
uniform highp usampler2D steps; // r16ui
uniform highp sampler2D table;  // r32f, 256 x 256, a row for every upper byte
layout(location = 0) out highp float depth_m;

void main() {
    uint step = texelFetch(steps, ivec2(gl_FragCoord.xy), 0).r;
    depth_m = texelFetch(table, ivec2(step & 255u, step >> 8u), 0).r;
}
