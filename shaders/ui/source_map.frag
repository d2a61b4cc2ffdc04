// Paints a picture of the virtual camera in its rigs' colours, mixed by their shares, brightness kept; what no rig sees
// is hatched, in another colour where one saw it before.
#define RIGS 4

uniform sampler2D picture;       // alpha below a half: filled
uniform sampler2D shares;        // of each rig, a channel each
uniform vec3 rig_colour[RIGS];
uniform vec3 filled_colour, remembered_colour;
uniform float remembered_alpha;

layout(location = 0) out vec4 overlaid;

const int stripe_px = 4;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 c = texelFetch(picture, at, 0);
    float luma = dot(c.rgb, vec3(0.299, 0.587, 0.114));
    if (c.a < 0.5) {
        bool on_stripe = ((at.x + at.y) / stripe_px & 1) == 0;
        vec3 stripe = abs(c.a - remembered_alpha) < 0.002 ? remembered_colour : filled_colour;
        overlaid = vec4(on_stripe ? stripe : 0.4 * c.rgb, c.a);
        return;
    }
    vec4 share = texelFetch(shares, at, 0);
    vec3 mixed = share.r * rig_colour[0] + share.g * rig_colour[1] + share.b * rig_colour[2] + share.a * rig_colour[3];
    overlaid = vec4(mixed * mix(0.35, 1.1, luma), c.a);
}
