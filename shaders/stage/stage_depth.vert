// Positions only: for the depth picture and the shadow map of the virtual stage.
#include "stage_transform.glsl"

uniform mat4 clip_from_world;

void main() {
    gl_Position = clip_from_world * vec4(to_world(vec4(position_m, 1.0)), 1.0);
}
