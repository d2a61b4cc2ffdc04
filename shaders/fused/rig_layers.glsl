// The inputs that RigLayers binds: the rigs' surfaces in the virtual view, and the rigs' own images.
#ifndef LAYERS
#define LAYERS 4
#endif
#ifndef ORIGINS
#define ORIGINS 0  // 1: the shader writes the layers' shares in each colour
#endif

#include "detail_level.glsl"

uniform sampler2D layer_depth[LAYERS];   // of the virtual view: 1 - near / z, 1 = nothing
uniform sampler2D colour[LAYERS];        // the rigs' own
uniform sampler2D source_depth[LAYERS];  // the rigs' own, metres; 0 = unknown, negative = inpainted
uniform mat4 pixel_from_target[LAYERS];  // the rigs' (u * z, v * z, z, 1) from the virtual camera's
uniform vec2 colour_size[LAYERS];         // px
uniform vec3 centre[LAYERS];             // of the rig's camera, in the virtual camera's coordinates
uniform float spread[LAYERS];            // relative uncertainty of depth, per metre of depth
uniform float presence[LAYERS];          // 0..1, less while a rig comes or goes
uniform mat3 ray_from_pixel;             // of the virtual camera
uniform float near_m;

// Runs X(0), X(1), ... for every layer: samplers take constant indices only.
#if LAYERS == 1
#define FOR_LAYERS(X) X(0)
#elif LAYERS == 2
#define FOR_LAYERS(X) X(0) X(1)
#elif LAYERS == 3
#define FOR_LAYERS(X) X(0) X(1) X(2)
#else
#define FOR_LAYERS(X) X(0) X(1) X(2) X(3)
#endif

const float nothing = 1e30;

float layer_z(sampler2D layer, ivec2 at) {
    float d = texelFetch(layer, at, 0).r;
    return d < 1.0 ? near_m / (1.0 - d) : nothing;
}

// Depth of a layer that matted_depth.frag drew.
float matted_layer_z(sampler2D layer, ivec2 at) {
    float d = texelFetch(layer, at, 0).r;
    return d < 1.0 ? near_m / (1.0 - 2.0 * (d < 0.5 ? d : d - 0.5)) : nothing;
}

// Angle-like measure between the two lines of sight to a point: 1 - cosine.
float apart(vec3 point, vec3 rig_centre) {
    return 1.0 - dot(normalize(point), normalize(point - rig_centre));
}

// The alpha of a surface: full if a rig sees it now, less if it is only remembered or inpainted.
uniform float remembered_confidence;  // a colour's alpha, up to which it is only remembered
uniform float remembered_alpha;  // of a picture

float alpha_of(bool is_known, float confidence) {
    return !is_known ? 0.25 : confidence > remembered_confidence + 0.5 / 255.0 ? 1.0 : remembered_alpha;
}

#if ORIGINS
layout(location = 2) out vec4 origins;
#endif
// Writes the share of every layer in this pixel's colour.
void tell_origins(vec4 shares) {
#if ORIGINS
    origins = shares;
#endif
}
