// A vertex of a baked background, in its owner's depth map, and its places in the pictures of the rigs that see it.
#ifndef SOURCES
#define SOURCES 4
#endif

layout(location = 0) in vec3 pixel;  // (u * z, v * z, z)

uniform mat4 clip_from_pixel;             // on (u * z, v * z, z, 1)
uniform mat4 target_from_pixel;           // the virtual camera's coordinates
uniform mat4 source_from_pixel[SOURCES];  // (x * z, y * z, z) with x and y in 0..1 across a rig's picture
uniform vec3 centre[SOURCES];             // of the rig's camera, in the virtual camera's coordinates
uniform float presence[SOURCES];          // 0: there is no such rig

out vec3 place[SOURCES];  // the same
out vec4 closeness;       // of the rigs' lines of sight to the virtual camera's

void main() {
    gl_Position = clip_from_pixel * vec4(pixel, 1.0);
    vec3 point = (target_from_pixel * vec4(pixel, 1.0)).xyz, ray = normalize(point);
    closeness = vec4(0.0);
    for (int k = 0; k < SOURCES; ++k) {
        place[k] = (source_from_pixel[k] * vec4(pixel, 1.0)).xyz;
        float apart = 1.0 - dot(ray, normalize(point - centre[k]));
        closeness[k] = presence[k] / (apart + 1e-5);
    }
}
