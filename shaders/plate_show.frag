// Fills what no rig sees with what one rig's background plate remembers, unless a rig sees through it by now.
#include "rig_layers.glsl"

uniform sampler2D picture;          // alpha below a half: not seen
uniform sampler2D picture_depth;    // metres
uniform sampler2D plate_layer;      // of the virtual view: 1 - near / z, 1 = nothing
uniform sampler2D plate_colour;     // the rig's own; alpha: confirmations
uniform mat4 plate_from_target;     // the plate's (u * z, v * z, z, 1) from the virtual camera's
uniform float edge_ratio;           // two depths whose ratio is larger lie on two surfaces
uniform float remembered_alpha;

layout(location = 0) out vec4 shown;
layout(location = 1) out float shown_depth;

const float confirmed = 0.7;

bool sees_through(int i, sampler2D map, vec2 pixel, float z) {
    vec4 q = pixel_from_target[i] * vec4(pixel * z, z, 1.0);
    vec2 uv = (q.xy / q.z + 0.5) / colour_size[i];
    if (q.z <= 0.0 || any(lessThan(uv, vec2(0.0))) || any(greaterThan(uv, vec2(1.0)))) return false;
    return texelFetch(map, ivec2(uv * vec2(textureSize(map, 0))), 0).r > q.z * edge_ratio;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 pixel = vec2(at);
    shown = texelFetch(picture, at, 0);
    shown_depth = texelFetch(picture_depth, at, 0).r;
    if (shown.a >= 0.5) return;
    float z = layer_z(plate_layer, at);
    if (z >= nothing) return;
    // Another plate may have been first: what stands before it hides it.
    if (shown.a > remembered_alpha - 0.01 && shown_depth < z * edge_ratio) return;
    vec4 q = plate_from_target * vec4(pixel * z, z, 1.0);
    vec4 c = textureLod(plate_colour, (q.xy / q.z + 0.5) / vec2(textureSize(plate_colour, 0)), 0.0);
    if (c.a < confirmed) return;
    bool is_gone = false;
#define LOOK(i) is_gone = is_gone || sees_through(i, source_depth[i], pixel, z);
    FOR_LAYERS(LOOK)
    if (is_gone) return;
    shown = vec4(c.rgb, remembered_alpha);
    shown_depth = z;
}
