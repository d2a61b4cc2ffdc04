// The colours of a baked background at this instant, behind a foreground: every rig that saw the surface when it was baked,
// and whose newest depth still has it, contributes its colour. Its weight is how well it saw the surface, times the
// confidence, and falls with the angle of its line of sight to the virtual camera's. Where no rig does, the colour is the
// one that was baked, unless a rig sees past the surface now.
#ifndef LAYERS
#define LAYERS 2
#endif
#include "plain_blend.glsl"
#include "tolerances.glsl"

uniform sampler2D baked_colour;      // alpha is below one half where the place was never seen
uniform sampler2D baked_depth;       // metres, 0 = nothing, negative where the place was never seen
uniform sampler2D visibility;        // how well each rig sees the surface, in the order of the layers
uniform sampler2D foreground;        // premultiplied by alpha
uniform sampler2D foreground_depth;  // metres, 0 = none
#if ORIGINS
uniform sampler2D foreground_shares;
#endif

layout(location = 0) out vec4 shown;
layout(location = 1) out float shown_z;

const float typical = 100.0;  // the scene's typical depth, relative to the near plane's
const int steps = 3;          // from such a surface to the one that a rig sees

// Where a rig sees past a surface at depth z, which no rig has any more, shows what that rig sees there: it sees past
// where its own depth is at least a share of the surface's. Returns false where it does not.
bool show_past(int i, sampler2D picture, sampler2D map, vec2 pixel, float z, float share) {
    vec2 uv;
    for (int k = 0; k < steps; ++k) {
        vec4 q = pixel_from_target[i] * vec4(pixel * z, z, 1.0);
        uv = (q.xy / q.z + 0.5) / colour_size[i];
        vec2 margin = min(uv, 1.0 - uv);
        if (q.z <= 0.0 || min(margin.x, margin.y) < 0.0) return false;
        float there = abs(textureLod(map, uv, 0.0).r);
        if (there <= 0.0 || (k == 0 && there < share * q.z)) return false;
        z *= there / q.z;
    }
    shown = vec4(textureLod(picture, uv, 0.0).rgb, 1.0);
    shown_z = z;
    vec4 shares = vec4(0.0);
    shares[i] = 1.0;
    tell_origins(shares);
    return true;
}

// Shows what the first rig sees that sees past a surface at depth z.
void show_what_rigs_see(vec2 pixel, float z, float share) {
    bool is_shown = false;
#define SHOW_FROM(i) is_shown = is_shown || show_past(i, colour[i], source_depth[i], pixel, z, share);
    FOR_LAYERS(SHOW_FROM)
}

void show_background(ivec2 at) {
    float own = texelFetch(baked_depth, at, 0).r, z = abs(own);
    shown = texelFetch(baked_colour, at, 0);
    shown_z = own;
    tell_origins(vec4(0.0));
    if (z == 0.0) {
        show_what_rigs_see(vec2(at), typical * near_m, 0.0);  // no probe reaches here
        return;
    }
    vec4 sees = texelFetch(visibility, at, 0);
    Blend blend = Blend(vec3(0.0), vec4(0.0), 0.0, 0.0);
#define ADD(i) add(i, colour[i], source_depth[i], vec2(at), z, sees[i], blend);
    FOR_LAYERS(ADD)
    if (blend.weight == 0.0) {
        show_what_rigs_see(vec2(at), z, 1.0 + view_edge_share);
        return;
    }
    shown = vec4(blend.sum / blend.weight, alpha_of(own > 0.0, blend.confidence));
    shown_z = z;
    tell_origins(blend.shares / blend.weight);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    show_background(at);
    vec4 before = texelFetch(foreground, at, 0);
    shown.rgb = before.rgb + (1.0 - before.a) * shown.rgb;
    if (before.a <= 0.5) return;
    shown.a = 1.0;
    shown_z = texelFetch(foreground_depth, at, 0).r;
#if ORIGINS
    tell_origins(texelFetch(foreground_shares, at, 0));
#endif
}
