// Converts a camera's buffer to RGBA.
#include "camera_formats.glsl"
uniform sampler2D raw;       // grey: r8; Y10, Y16: rg8, low byte first; YUYV: rgba8; NV12: r8, luma
uniform sampler2D chroma;    // NV12: rg8 of half the size
uniform int first_column_px; // of the part that is wanted
layout(location = 0) out vec4 colour;

ivec4 texel(sampler2D from, ivec2 at) { return ivec4(texelFetch(from, at, 0) * 255.0 + 0.5); }

vec4 grey(int value) { return vec4(vec3(float(min(value, 255)) / 255.0), 1.0); }

vec4 from_yuv(int y, int u, int v) { return vec4(rgb_of_yuv(y, u, v) / 255.0, 1.0); }

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy) + ivec2(first_column_px, 0);
#if FORMAT == 0
    colour = grey(texel(raw, at).r);
#elif FORMAT == 1
    ivec4 bytes = texel(raw, at);
    colour = grey((bytes.r | bytes.g << 8) >> 2);
#elif FORMAT == 2
    colour = grey(texel(raw, at).g);
#elif FORMAT == 3
    ivec4 pair = texel(raw, ivec2(at.x >> 1, at.y));
    colour = from_yuv((at.x & 1) == 0 ? pair.r : pair.b, pair.g, pair.a);
#else
    ivec4 uv = texel(chroma, at >> 1);
    colour = from_yuv(texel(raw, at).r, uv.r, uv.g);
#endif
}
