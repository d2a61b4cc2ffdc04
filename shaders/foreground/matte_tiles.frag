// The tiles of a rig's image that the matte may cover: those near pixels of foreground, and those with changed pixels in
// a region that may be foreground.
#include "background_kinds.glsl"

uniform sampler2D seen;      // from background_compare.frag
uniform sampler2D votes;     // from matte_votes.frag, with mip levels
uniform vec2 tile_share;     // size of a tile, relative to the image
uniform vec2 margin_share;   // how far a matte extends beyond differing pixels, relative to the image

layout(location = 0) out float tile;

const float region_lod = 6.0;     // of the votes: 64 px
const float min_foreground = 0.02;  // their share there

void main() {
    vec2 size = vec2(textureSize(seen, 0)), corner = (gl_FragCoord.xy - 0.5) * tile_share;
    ivec2 first = ivec2(floor((corner - margin_share) * size)), last = ivec2(ceil((corner + tile_share + margin_share) * size));
    vec4 most = vec4(0.0);
    // A gather reads four pixels, the first of which is (x, y).
    for (int y = first.y; y < last.y; y += 2)
        for (int x = first.x; x < last.x; x += 2)
            most = max(most, textureGather(seen, vec2(x + 1, y + 1) / size, 0));
    float kind = max(max(most.x, most.y), max(most.z, most.w));
    bool is_changed = kind > 0.5 * lit_background;
    float around = textureLod(votes, gl_FragCoord.xy * tile_share, region_lod).r;
    tile = is_apart(kind) || (is_changed && around > min_foreground) ? 1.0 : 0.0;
}
