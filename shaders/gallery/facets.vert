// A facet for every voxel that a rig's depth map reaches (Yamazaki et al., 2002): a square through the voxel's middle that
// faces the virtual camera and covers it from every side. Of neighbouring pixels in one voxel only the first draws it.
uniform sampler2D depth_map;    // metres, 0 = unknown, negative = guessed
uniform mat4 grid_from_pixel;   // coordinates in which the voxels stand, from the depth map's (u * z, v * z, z, 1)
uniform mat4 target_from_grid;  // the virtual camera's coordinates from those
uniform mat4 clip_from_target;
uniform float voxel_m;

flat out float facet_z;  // from the virtual camera, metres

const float half_diagonal = 0.87;  // of a voxel

vec3 voxel_at(ivec2 at, out float z) {
    z = abs(texelFetch(depth_map, at, 0).r);
    return floor((grid_from_pixel * vec4(vec2(at) * z, z, 1.0)).xyz / voxel_m);
}

void main() {
    ivec2 size = textureSize(depth_map, 0);
    int pixel = gl_VertexID / 6, corner = gl_VertexID % 6;
    ivec2 at = ivec2(pixel % size.x, pixel / size.x);
    float z, other_z;
    vec3 voxel = voxel_at(at, z);
    bool is_first = at.x == 0 || voxel_at(at - ivec2(1, 0), other_z) != voxel || other_z == 0.0;
    is_first = is_first && (at.y == 0 || voxel_at(at - ivec2(0, 1), other_z) != voxel || other_z == 0.0);
    vec4 middle = target_from_grid * vec4((voxel + 0.5) * voxel_m, 1.0);
    facet_z = middle.z;
    // Two triangles: 0 1 2, 2 1 3.
    int place = corner < 3 ? corner : corner == 3 ? 2 : corner == 4 ? 1 : 3;
    vec2 aside = half_diagonal * voxel_m * (2.0 * vec2(place & 1, place >> 1) - 1.0);
    gl_Position = clip_from_target * vec4(middle.xy + aside, middle.zw);
    vec3 rig = (target_from_grid * grid_from_pixel * vec4(0.0, 0.0, 0.0, 1.0)).xyz;
    // Behind the clip volume; with it what is seen from behind, whose look is not known.
    if (z == 0.0 || !is_first || middle.z <= 0.0 || dot(middle.xyz - rig, middle.xyz) <= 0.0) gl_Position = vec4(0.0, 0.0, -2.0, 1.0);
}
