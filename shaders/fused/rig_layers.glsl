// The inputs that RigLayers binds: the rigs' surfaces in the virtual view, and the rigs' own images.
#ifndef LAYERS
#define LAYERS 4
#endif
#ifndef ORIGINS
#define ORIGINS 0  // 1: the shader writes the layers' shares in each colour
#endif

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

// How much the virtual camera stands at a rig's own place, 1 to 0, by its distance from that rig relative to the next
// one's. There the rig's image is what a camera sees, whatever depth its pixels have, and other rigs fill what it lacks.
const vec2 own_place = vec2(0.03, 0.3);

float own(int i) {
#if LAYERS == 1
    return 0.0;
#else
    float next = 1e9;
#define NEXT(j) if (i != j) next = min(next, length(centre[j]));
    FOR_LAYERS(NEXT)
    return presence[i] * (1.0 - smoothstep(own_place.x, own_place.y, length(centre[i]) / max(next, 1e-9)));
#endif
}

// Whether another rig's surface is in front of a rig's own one by so much that it hides it.
bool hides(float z, float own_z, float its_own) { return z < own_z * (1.0 - its_own); }

// Level of detail at which one source pixel is about one pixel of the virtual view.
float detail_level(mat4 source_from_target, float z, float source_z) {
    return log2(max(length(source_from_target[0].xyz) * z / source_z, 1.0));
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
