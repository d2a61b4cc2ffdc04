// Where a vertex of the virtual stage is in the world: each hangs on one bone; bone 0 stands still.
#ifndef BONES
#define BONES 64
#endif
layout(location = 0) in vec3 position_m;
layout(location = 2) in ivec4 normal_and_bone;

// The upper three rows of each world_from_bone.
uniform vec4 bones[3 * BONES];

vec3 to_world(vec4 v) {
    int row = 3 * normal_and_bone.w;
    return vec3(dot(bones[row], v), dot(bones[row + 1], v), dot(bones[row + 2], v));
}
