// The tiles of a rig's image that the matte may cover: those near pixels that differ from the background.
#include "background_kinds.glsl"

uniform sampler2D seen;      // from background_compare.frag
uniform vec2 tile_share;     // size of a tile, relative to the image
uniform vec2 margin_share;   // how far a matte extends beyond differing pixels, relative to the image

layout(location = 0) out float tile;

void main() {
    vec2 size = vec2(textureSize(seen, 0)), corner = (gl_FragCoord.xy - 0.5) * tile_share;
    ivec2 first = ivec2(floor((corner - margin_share) * size)), last = ivec2(ceil((corner + tile_share + margin_share) * size));
    vec4 most = vec4(0.0);
    // A gather reads four pixels, the first of which is (x, y).
    for (int y = first.y; y < last.y; y += 2)
        for (int x = first.x; x < last.x; x += 2)
            most = max(most, textureGather(seen, vec2(x + 1, y + 1) / size, 0));
    tile = is_apart(max(max(most.x, most.y), max(most.z, most.w))) ? 1.0 : 0.0;
}
