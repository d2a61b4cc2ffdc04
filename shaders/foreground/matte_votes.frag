// The pixels of a rig's image whose comparison with the background is decided, as votes for the regions of
// matte_region.frag: for the foreground (red) and for the background (green). Its mip levels average them.
#include "background_kinds.glsl"

uniform sampler2D seen;  // from background_compare.frag

layout(location = 0) out vec2 votes;

void main() {
    float kind = texelFetch(seen, ivec2(gl_FragCoord.xy), 0).r;
    votes = vec2(is_apart(kind) ? 1.0 : 0.0, is_kind(kind, the_background) || is_kind(kind, new_background) ? 1.0 : 0.0);
}
