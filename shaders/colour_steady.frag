// Takes the noise out of a rig's picture where nothing moves: the mean of the instants since it last changed. Changes
// are told from noise by their mean over a window and, for fine texture that moves, by the pixel's own.
uniform sampler2D picture;  // this instant's
uniform sampler2D before;   // mean of the instants before; alpha: how many they were, 0 = it has just changed
uniform float has_before;   // 0: there is no instant before
uniform float most_instants;  // that the mean is of

layout(location = 0) out vec4 steady;
layout(location = 1) out vec4 mean;

// Changes of colour (0..1): up to `noise` they are averaged away, from `motion` on taken as they come; a window whose
// mean changes by as much shows another thing.
const float noise = 0.01, motion = 0.02;
const float pixel_share = 0.4;  // a pixel's noise is larger than that of a window

float largest(vec3 change) {
    change = abs(change);
    return max(change.r, max(change.g, change.b));
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 now = texelFetch(picture, at, 0);
    steady = now;
    mean = vec4(now.rgb, 0.0);
    if (has_before == 0.0) return;
    vec4 past = texelFetch(before, at, 0);
    vec2 texel = 1.0 / vec2(textureSize(picture, 0));
    // Seventeen pixels of five by five: the middle and two by two at each corner.
    vec3 window = now.rgb - past.rgb;
    for (int k = 0; k < 4; ++k) {
        vec2 corner = vec2(at + 3 * ivec2(k & 1, k >> 1) - 1) * texel;
        window += 4.0 * (textureLod(picture, corner, 0.0).rgb - textureLod(before, corner, 0.0).rgb);
    }
    float change = largest(window / 17.0);
    if (change > motion) return;
    change = max(change, pixel_share * largest(now.rgb - past.rgb));
    float instants = min(past.a + 1.0, most_instants);
    mean = vec4(mix(past.rgb, now.rgb, max(1.0 / (instants + 1.0), smoothstep(noise, motion, change))), instants);
    steady.rgb = mean.rgb;
}
