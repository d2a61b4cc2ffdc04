// A rig's picture at this instant, denoised where it shows the background.
#include "colour_difference.glsl"
#include "tolerances.glsl"

uniform sampler2D picture;
uniform sampler2D background_colour;  // from background_colour.frag: alpha is 1 where the background is visible now

layout(location = 0) out vec4 shown;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 now = texelFetch(picture, at, 0).rgb;
    vec4 background = texelFetch(background_colour, at, 0);
    float change = background.a == 1.0 ? largest(now - background.rgb) : 1.0;
    shown = vec4(mix(background.rgb, now, smoothstep(motion_change, 2.0 * motion_change, change)), 1.0);
}
