// A vertex for each pixel of the depth map, displaced by its depth; with RIMS nine for each pixel: its middle and those
// around it.
#ifndef RIMS
#define RIMS 0
#endif
#ifndef MATTED
#define MATTED 0  // 1: for matted_depth.frag
#endif
uniform sampler2D depth_map;  // metres, 0 = unknown, negative = inpainted
uniform mat4 clip_from_pixel; // on (u * z, v * z, z, 1)
#if RIMS
uniform float reach_px;       // of a rim from the middle of its pixel
#endif

#if MATTED
out vec2 place_px;
#endif

void main() {
    int width = textureSize(depth_map, 0).x;
#if RIMS
    int pixel = gl_VertexID / 9, place = gl_VertexID % 9;
    vec2 aside = reach_px * vec2(place % 3 - 1, place / 3 - 1);
#else
    int pixel = gl_VertexID;
    vec2 aside = vec2(0.0);
#endif
    ivec2 at = ivec2(pixel % width, pixel / width);
    float z = abs(texelFetch(depth_map, at, 0).r);
#if MATTED
    place_px = vec2(at);
#endif
    gl_Position = clip_from_pixel * vec4((vec2(at) + aside) * z, z, 1.0);
}
