// Looks for things that a rig's matcher took for what is behind them: rails, stands, what is as thin as a pixel. Where
// the set's depth is no more than a guess, all depths of the stage are tried: the one at which the two nearest other
// rigs' pictures are most like this one's, in a window that keeps to the pixel's colour.
#include "rig_others.glsl"

uniform sampler2D before;  // metres, 0 = unknown, negative = guessed
uniform vec2 range;        // of inverse depth

layout(location = 0) out float found;  // inverse depth, 0 = nothing

#ifndef STEPS
#define STEPS 128  // from one end of the range to the other
#endif

const int taps = 13;               // the middle and three rings of four
const float like_colour = 0.06;    // mean difference (0..1) at which a pixel's weight is 1/e
// Mean colour differences (0..1): of the window, at most; of the middle, beyond which the window is not looked at; and
// beyond which nothing is more unlike.
const float alike = 0.12, middle_alike = 0.15, most_unlike = 0.15;

vec3 window[taps];    // this rig's picture around the pixel
float weights[taps];  // how far its pixels are of the middle's colour; their sum is 1

vec2 aside(int k) {
    float ring = float((k + 3) / 4), angle = 1.5707963 * float(k) + 0.785398 * float(ring == 2.0);
    return (ring == 3.0 ? 3.0 : ring == 2.0 ? 2.1 : ring) * vec2(cos(angle), sin(angle));
}

void look_around(vec2 pixel) {
    vec2 texel = 1.0 / vec2(textureSize(before, 0));
    float sum = 0.0;
    for (int k = 0; k < taps; ++k) {
        window[k] = textureLod(picture, (pixel + 0.5 + aside(k)) * texel, 0.0).rgb;
        weights[k] = exp(-dot(abs(window[k] - window[0]), vec3(1.0 / 3.0)) / like_colour);
        sum += weights[k];
    }
    for (int k = 0; k < taps; ++k) weights[k] /= sum;
}

float unlike_at(int i, sampler2D colours, vec2 pixel, float nearness, int k) {
    vec3 p = (other_from_pixel[i] * vec4(pixel + aside(k), 1.0, nearness)).xyz;
    vec2 uv = (p.xy / p.z + 0.5) / other_size[i];
    if (p.z <= 0.0 || any(notEqual(uv, clamp(uv, 0.0, 1.0)))) return 1.0;
    return dot(abs(textureLod(colours, uv, 0.0).rgb - window[k]), vec3(1.0 / 3.0));
}

float unlike_around(int i, sampler2D colours, vec2 pixel, float nearness) {
    float sum = 0.0;
    for (int k = 0; k < taps; ++k) sum += weights[k] * min(unlike_at(i, colours, pixel, nearness, k), most_unlike);
    return sum;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 pixel = vec2(at);
    found = 0.0;
    if (texelFetch(before, at, 0).r > 0.0) return;
    look_around(pixel);
    float least = alike;
    for (int h = 0; h < STEPS; ++h) {
        float nearness = mix(range.x, range.y, float(h) / float(STEPS - 1));
        if (unlike_at(0, other_colour[0], pixel, nearness, 0) > middle_alike) continue;
        if (unlike_at(1, other_colour[1], pixel, nearness, 0) > middle_alike) continue;
        float unlike = 0.5 * (unlike_around(0, other_colour[0], pixel, nearness) +
                              unlike_around(1, other_colour[1], pixel, nearness));
        if (unlike < least) least = unlike, found = nearness;
    }
}
