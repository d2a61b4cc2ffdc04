// The corners of a probe's planar tiles. Inverse depth is linear over a plane's picture, so that (u, v, 1, inverse depth)
// are homogeneous coordinates in which a tile is flat.
uniform mat4 clip_from_pixel;  // on (u * z, v * z, z, 1)

layout(location = 0) in vec4 corner;  // u px, v px, inverse depth 1/m, tolerance 1/m

out vec2 place_px;
out float plane;  // inverse depth
out float tolerance;

void main() {
    place_px = corner.xy;
    plane = corner.z;
    tolerance = corner.w;
    gl_Position = clip_from_pixel * vec4(corner.xy, 1.0, corner.z);
}
