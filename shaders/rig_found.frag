// Takes over what rig_search.frag found for guessed depth, where a third of the pixels around of like colour has the same:
// chance agrees with nobody.
uniform sampler2D before;   // metres, 0 = unknown, negative = guessed
uniform sampler2D found;    // inverse depth, 0 = nothing
uniform sampler2D picture;

layout(location = 0) out float kept;  // metres, 0 = unknown, negative = guessed

#ifndef REACH
#define REACH 3  // px to either side
#endif
const float like_colour = 0.1;   // mean difference (0..1) up to which a pixel is asked
const float same_place = 0.02;   // relative depth
const float enough = 0.33;       // of those asked
const float fewest = 5.0;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(found, 0) - 1;
    vec2 texel = 1.0 / vec2(last + 1);
    kept = texelFetch(before, at, 0).r;
    float own = texelFetch(found, at, 0).r;
    if (kept > 0.0 || own == 0.0) return;
    vec3 colour = textureLod(picture, (vec2(at) + 0.5) * texel, 0.0).rgb;
    float asked = 0.0, same = 0.0, sum = 0.0;
    for (int y = -REACH; y <= REACH; ++y)
        for (int x = -REACH; x <= REACH; ++x) {
            ivec2 there = clamp(at + ivec2(x, y), ivec2(0), last);
            vec3 off = abs(textureLod(picture, (vec2(there) + 0.5) * texel, 0.0).rgb - colour);
            if (dot(off, vec3(1.0 / 3.0)) > like_colour) continue;
            float z = texelFetch(before, there, 0).r, nearness = z > 0.0 ? 1.0 / z : texelFetch(found, there, 0).r;
            asked += 1.0;
            if (nearness == 0.0 || abs(nearness / own - 1.0) > same_place) continue;
            same += 1.0;
            sum += nearness;
        }
    if (same >= fewest && same > enough * asked) kept = same / sum;
}
