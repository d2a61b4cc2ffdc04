// A tile of a probe in another view: its colour, and its depth there. The pixels of the probe that lie on the tile's plane
// decide where it ends, interpolated, so that its edges are finer than the probe's pixels.
uniform sampler2D colour;         // alpha is below one half where the place was never seen
uniform sampler2D inverse_depth;  // 1/m, 0 = none
uniform sampler2D visibility;     // how well each of the probe's rigs sees the surface; 0 for a guessed tile
uniform mat4 layer_from_channel;  // which rigs are wanted, in which order
uniform float colour_cell_px;     // the probe's pixels that one of `colour` spans
uniform bool is_guessed;          // the tile lies behind all that was seen, and has no edges

in vec2 place_px;
in float plane;
in float tolerance;

layout(location = 0) out vec4 shown;
layout(location = 1) out float depth_m;  // negative where the place was never seen
layout(location = 2) out vec4 sees;

void main() {
    if (!is_guessed) {
        vec2 size = vec2(textureSize(inverse_depth, 0));
        vec2 at = clamp(place_px, vec2(0.0), size - 1.0);
        vec2 f = fract(at);
        vec4 there = textureGather(inverse_depth, (floor(at) + 1.0) / size);
        vec4 lies_on = step(abs(there - plane), vec4(tolerance));
        vec4 share = vec4((1.0 - f.x) * f.y, f.x * f.y, f.x * (1.0 - f.y), (1.0 - f.x) * (1.0 - f.y));
        if (dot(lies_on, share) < 0.5) discard;
    }
    vec2 uv = (place_px + 0.5) / (colour_cell_px * vec2(textureSize(colour, 0)));
    vec4 c = textureLod(colour, uv, 0.0);
    sees = layer_from_channel * textureLod(visibility, uv, 0.0);
    float z = 1.0 / (gl_FragCoord.w * plane);
    shown = c;
    depth_m = c.a >= 0.5 ? z : -z;
}
