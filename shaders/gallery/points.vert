// A splat for every pixel of a depth map, as large as the pixel is in the virtual view.
uniform sampler2D depth_map;   // metres, 0 = unknown
uniform sampler2D picture;
uniform mat4 clip_from_pixel;  // on (u * z, v * z, z, 1)
uniform vec3 centre;           // of the virtual camera, in the rig camera's coordinates
uniform mat3 ray_from_pixel;   // of the depth map
uniform float scale;           // virtual px per depth map px, where both cameras are equally far

flat out vec4 splat_colour;
flat out float splat_z;

const float overlap = 1.4;  // so that the splats of a slanted surface close
const float largest_px = 64.0;

void main() {
    ivec2 size = textureSize(depth_map, 0);
    ivec2 at = ivec2(gl_VertexID % size.x, gl_VertexID / size.x);
    float z = texelFetch(depth_map, at, 0).r;
    vec3 point = ray_from_pixel * vec3(vec2(at), 1.0) * z;
    gl_Position = clip_from_pixel * vec4(vec2(at) * z, z, 1.0);
    gl_PointSize = clamp(overlap * scale * z / gl_Position.w, 1.0, largest_px);
    splat_z = gl_Position.w;
    splat_colour = vec4(textureLod(picture, (vec2(at) + 0.5) / vec2(size), 0.0).rgb, 1.0);
    // The back of a surface is not known: behind the clip volume with it, as with what has no depth.
    if (z <= 0.0 || dot(point, point - centre) <= 0.0) gl_Position = vec4(0.0, 0.0, -2.0, 1.0);
}
