// A rig's own picture over a synthesised one, in a virtual view near the rig. There the depth hardly matters: at the rig's
// own place the picture is right whatever the depth is, and elsewhere it is wrong by at most its parallax. The weight of
// the rig's picture falls with the parallax of its own surface, to which the other rigs' errors do not contribute.
#ifndef SHARES
#define SHARES 0  // 1: the pictures are the rigs' shares in the colours
#endif
#include "detail_level.glsl"
#include "sharp_sample.glsl"

uniform sampler2D picture;           // the synthesised one, or its shares
uniform sampler2D depth_m;           // its depth, 0 = nothing; the sign has no meaning
uniform sampler2D own;               // the rig's picture
uniform sampler2D background_depth;  // of the rig, metres, 0 = unknown, negative = inpainted
uniform sampler2D foreground;        // of the rig; alpha: its share of each pixel
uniform sampler2D foreground_depth;  // metres, 0 = none, negative beyond its share
uniform mat4 pixel_from_target;      // the rig's (u * z, v * z, z, 1) from the virtual camera's
uniform float typical_m;             // depth where none is known
uniform float rig_weight;            // 0..1, less farther from the rig, and while it comes or goes
uniform vec2 parallax_px;            // in the rig's picture: up to the first, its picture prevails; from the second on it does not count
#if SHARES
uniform vec4 own_share;  // 1 in the rig's channel
#endif

layout(location = 0) out vec4 shown;

const float border_px = 1.5;  // of the rig's picture, in which its weight falls to 0

vec3 project(vec2 pixel, float z) { return (pixel_from_target * vec4(pixel * z, z, 1.0)).xyz; }

float own_depth_m(vec2 uv) {
    float before = abs(textureLod(foreground_depth, uv, 0.0).r);
    if (before > 0.0 && textureLod(foreground, uv, 0.0).a >= 0.5) return before;
    return abs(textureLod(background_depth, uv, 0.0).r);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 pixel = vec2(at), size = vec2(textureSize(own, 0));
    shown = texelFetch(picture, at, 0);
    float z = abs(texelFetch(depth_m, at, 0).r);
    z = z > 0.0 ? z : typical_m;
    vec3 q = project(pixel, z);
    vec3 far = mat3(pixel_from_target) * vec3(pixel, 1.0);
    if (q.z <= 0.0 || far.z <= 0.0) return;
    // The rig's depth there, in the virtual camera's: both look the same way.
    float found = own_depth_m((q.xy / q.z + 0.5) / size);
    if (found > 0.0) {
        z *= found / q.z;
        q = project(pixel, z);
        if (q.z <= 0.0) return;
    }
    vec2 place = q.xy / q.z;
    vec2 inside = min(place, size - 1.0 - place);
    float weight = rig_weight * (1.0 - smoothstep(parallax_px.x, parallax_px.y, distance(place, far.xy / far.z))) *
                   clamp(1.0 + min(inside.x, inside.y) / border_px, 0.0, 1.0);
    if (weight <= 0.0) return;
#if SHARES
    shown = mix(shown, own_share, weight);
#else
    float lod = detail_level(pixel_from_target, z, q.z);
    shown = mix(shown, vec4(sharp(own, (place + 0.5) / size, lod), 1.0), weight);
#endif
}
