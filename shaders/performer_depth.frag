// The depth of what stands before a rig's set: measured where it was, elsewhere that of the pixels around that look
// alike; smoothed within surfaces. Beyond the matte it goes on for some pixels, negative, as near as what is nearest
// there, unless the set stands before it: the matte ends a performer, not where depth does.
uniform sampler2D depth_map;  // from performer_carve.frag, metres, 0 = unknown
uniform sampler2D picture;
uniform sampler2D matte;      // the performers' share
uniform sampler2D set_depth;  // metres
uniform float edge_ratio;     // two depths whose ratio is larger lie on two surfaces

layout(location = 0) out float performer_m;  // metres, 0 = nothing, negative = beyond the matte

const int taps = 25;             // the middle and three rings
const float step_px = 2.0;       // from one ring to the next
const float smooth_steps = 0.7;
const float like_colour = 0.06;  // difference (0..1) at which a pixel's weight is 1/e

bool is_measured(ivec2 at) { return texelFetch(depth_map, at, 0).r > 0.0; }

// The pixel `tap` away: the middle, then rings of eight.
ivec2 aside(int tap) {
    int ring = (tap + 7) / 8;
    float angle = 0.785398 * (float(tap) + 0.5 * float(ring & 1));
    return ring == 0 ? ivec2(0) : ivec2(round(step_px * float(ring) * vec2(cos(angle), sin(angle))));
}

float depth_in_ring(ivec2 at, ivec2 last, int ring) {
    float nearest = 0.0;
    for (int k = 8 * ring - 7; k <= 8 * ring; ++k) {
        float z = texelFetch(depth_map, clamp(at + aside(k), ivec2(0), last), 0).r;
        if (z > 0.0 && (nearest == 0.0 || z < nearest)) nearest = z;
    }
    return nearest;
}

// The nearest depth of the nearest ring that has any.
float depth_around(ivec2 at, ivec2 last) {
    float nearest = depth_in_ring(at, last, 1);
    if (nearest == 0.0) nearest = depth_in_ring(at, last, 2);
    if (nearest == 0.0) nearest = depth_in_ring(at, last, 3);
    return nearest;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(depth_map, 0) - 1;
    vec2 texel = 1.0 / vec2(last + 1), uv = (vec2(at) + 0.5) * texel;
    performer_m = 0.0;
    if (textureLod(matte, uv, 0.0).r == 0.0) {
        float z = depth_around(at, last), set = texelFetch(set_depth, at, 0).r;
        if (set <= 0.0 || set > z) performer_m = -z;
        return;
    }
    vec3 own = textureLod(picture, uv, 0.0).rgb;
    float z = is_measured(at) ? texelFetch(depth_map, at, 0).r : 0.0;
    float best = 0.0;
    // Of constant size and index, so that they stay in registers.
    float depths[taps], weights[taps];
    for (int k = 0; k < taps; ++k) {
        ivec2 there = clamp(at + aside(k), ivec2(0), last);
        float measured = texelFetch(depth_map, there, 0).r;
        vec3 off = abs(textureLod(picture, (vec2(there) + 0.5) * texel, 0.0).rgb - own);
        int ring = (k + 7) / 8;
        float far = float(ring * ring);
        float w = exp(-(off.r + off.g + off.b) / (3.0 * like_colour)) / (1.0 + 0.5 * far) + 1e-5;
        if (measured <= 0.0) w = 0.0;
        depths[k] = measured;
        weights[k] = w * exp(-0.5 * far / (smooth_steps * smooth_steps));
        if (z == 0.0 && w > best) best = w, performer_m = measured;
    }
    if (z > 0.0) performer_m = z;
    if (performer_m == 0.0) return;
    float sum = 0.0, all = 0.0;
    for (int k = 0; k < taps; ++k) {
        if (weights[k] == 0.0 || max(depths[k], performer_m) > min(depths[k], performer_m) * edge_ratio) continue;
        sum += weights[k] / depths[k];
        all += weights[k];
    }
    if (all > 0.0) performer_m = all / sum;
}
