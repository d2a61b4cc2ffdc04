// Guesses the depth of pixels that have none from the nearest known ones in eight directions, those of like colour
// above all: what one of two cameras does not see is mostly the background beside it, but a matcher also leaves out what
// is plain or shiny, and its own surface goes on there.
uniform sampler2D depth_map;  // metres, 0 = unknown, negative = guessed
uniform sampler2D measured;   // likewise: what was known before other rigs carved some of it away
uniform sampler2D picture;    // of the same rig
uniform float edge_ratio;     // two depths whose ratio is larger lie on two surfaces

layout(location = 0) out float inpainted;  // negative where it is a guess, 0 where no known pixel is near

const int directions = 8, steps = 9;
const float step_growth = 1.5;   // of the steps, from a pixel on
const float like_colour = 0.03;  // mean difference (0..1) at which a pixel's weight is 1/e
const float farther_first = 0.1; // weight of what is nearer than the farthest, of equal colour and distance

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), size = textureSize(depth_map, 0);
    inpainted = texelFetch(depth_map, at, 0).r;
    // What is carved away must not come back from what is left of it.
    if (inpainted != 0.0 || texelFetch(measured, at, 0).r != 0.0) return;
    vec2 texel = 1.0 / vec2(size), middle = (vec2(at) + 0.5) * texel;
    vec3 own = textureLod(picture, middle, 0.0).rgb;
    float z[directions], weight[directions], farthest = 0.0;
    for (int k = 0; k < directions; ++k) {
        float angle = 6.2831853 * float(k) / float(directions);
        vec2 along = vec2(cos(angle), sin(angle));
        float away = 1.0;
        z[k] = 0.0;
        for (int i = 0; i < steps && z[k] <= 0.0; ++i) {
            ivec2 there = at + ivec2(floor(along * away + 0.5));
            if (any(lessThan(there, ivec2(0))) || any(greaterThanEqual(there, size))) break;
            z[k] = max(texelFetch(depth_map, there, 0).r, 0.0);
            if (z[k] > 0.0) {
                vec3 off = abs(textureLod(picture, (vec2(there) + 0.5) * texel, 0.0).rgb - own);
                weight[k] = exp(-dot(off, vec3(1.0 / 3.0)) / like_colour) / away + 1e-6;
            }
            away *= step_growth;
        }
        farthest = max(farthest, z[k]);
    }
    if (farthest == 0.0) return;
    // Those that lie on the surface of most weight.
    float most = 0.0, inverse = 0.0;
    for (int k = 0; k < directions; ++k) {
        if (z[k] <= 0.0) continue;
        float sum = 0.0, sum_inverse = 0.0;
        for (int j = 0; j < directions; ++j) {
            if (z[j] <= 0.0 || max(z[j], z[k]) > min(z[j], z[k]) * edge_ratio) continue;
            sum += weight[j];
            sum_inverse += weight[j] / z[j];
        }
        float score = sum * (z[k] * edge_ratio < farthest ? farther_first : 1.0);
        if (score > most) {
            most = score;
            inverse = sum_inverse / sum;
        }
    }
    inpainted = -1.0 / inverse;
}
