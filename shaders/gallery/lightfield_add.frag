// Adds the rays of up to four cameras to a view of a light field (Levoy and Hanrahan, 1996). A pixel's line of sight
// meets the cameras' plane (uv) and the focal plane (st): cameras count by how near they stand to the former, and are
// looked into towards the latter, or, depth-corrected as in Gortler et al. (1996), towards the surface.
#ifndef CAMERAS
#define CAMERAS 4
#endif

uniform sampler2D sum_before;   // colour times weight, and weight
uniform sampler2D colour[CAMERAS];
uniform sampler2D source_depth[CAMERAS];   // the cameras' own, metres; one pixel of 0 where there is none
uniform mat4 pixel_from_target[CAMERAS];   // the cameras' (u * z, v * z, z, 1) from the virtual camera's
uniform vec2 place[CAMERAS];    // on the cameras' plane, metres
uniform vec4 reach[CAMERAS];    // left, right, up, down; 0: everywhere
uniform mat3 ray_from_pixel;    // of the virtual camera
uniform vec3 camera_x, camera_y, camera_middle;  // the cameras' plane in the virtual camera's coordinates
uniform vec4 camera_plane, focal_plane;          // normal and distance there
uniform sampler2D surface;      // its depth in the virtual view, metres, 0 = unknown
uniform float corrected;        // 1: lines are followed to the surface

layout(location = 0) out vec4 sum;

const float wide_share = 0.001;  // of a camera's weight reaches twice as far, for where cameras are missing
const float hidden = 1.03;       // depth over that of the camera's own surface, beyond which the camera does not see it

float tent(vec2 away, vec4 range) {
    vec2 side = vec2(away.x < 0.0 ? range.x : range.y, away.y < 0.0 ? range.z : range.w);
    float w = side.x > 0.0 ? max(0.0, 1.0 - abs(away.x) / side.x) : 1.0;
    return side.y > 0.0 ? w * max(0.0, 1.0 - abs(away.y) / side.y) : w;
}

vec4 look(int i, sampler2D picture, sampler2D its_depth, vec2 uv, vec2 pixel, float z, float is_surface) {
    vec2 away = uv - place[i];
    float weight = tent(away, reach[i]) + wide_share * tent(away, 2.01 * reach[i]);
    if (weight == 0.0) return vec4(0.0);
    vec4 q = pixel_from_target[i] * vec4(pixel * z, z, 1.0);
    vec2 at = (q.xy / max(q.z, 1e-6) + 0.5) / vec2(textureSize(picture, 0));
    vec2 inside = min(at, 1.0 - at);
    if (q.z <= 0.0 || min(inside.x, inside.y) < 0.0) return vec4(0.0);
    if (is_surface > 0.0) {
        float own = abs(textureLod(its_depth, at, 0.0).r);
        if (own > 0.0 && q.z > hidden * own) weight *= wide_share;
    }
    float level = log2(max(length(pixel_from_target[i][0].xyz) * z / q.z, 1.0));
    return weight * vec4(textureLod(picture, at, level).rgb, 1.0);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    sum = texelFetch(sum_before, at, 0);
    vec2 pixel = vec2(at);
    vec3 ray = ray_from_pixel * vec3(pixel, 1.0);
    float to_cameras = camera_plane.w / dot(camera_plane.xyz, ray);
    vec3 on_plane = ray * to_cameras - camera_middle;
    vec2 uv = vec2(dot(on_plane, camera_x), dot(on_plane, camera_y));
    float z = focal_plane.w / dot(focal_plane.xyz, ray);
    float is_surface = 0.0;
    if (corrected > 0.0) {
        float known = texelFetch(surface, at, 0).r;
        if (known > 0.0) {
            z = known;
            is_surface = 1.0;
        }
    }
    if (!(z > 0.0)) return;
#define LOOK(i) sum += look(i, colour[i], source_depth[i], uv, pixel, z, is_surface);
    LOOK(0)
#if CAMERAS > 1
    LOOK(1)
#endif
#if CAMERAS > 2
    LOOK(2)
#endif
#if CAMERAS > 3
    LOOK(3)
#endif
}
