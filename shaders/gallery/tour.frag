// A view into a single camera's film (Kang and Shin, 2002): its background, painted on a floor and a back plane, and its
// performers, cut out and standing on the floor as upright billboards.
const int most_cut_outs = 8;

uniform sampler2D background_colour;    // of the rig
uniform sampler2D picture;       // this instant's
uniform sampler2D matte;         // the performers' share
uniform sampler2D numbers;       // of the cut-out that a pixel belongs to, from 1 on, over 255
uniform mat4 pixel_from_target;  // the rig's (u * z, v * z, z, 1) from the virtual camera's
uniform vec2 picture_size;       // px
uniform mat3 ray_from_pixel;     // of the virtual camera
uniform vec4 floor_plane, back_plane;        // normal and distance in the virtual camera's coordinates
uniform vec4 billboards[most_cut_outs];      // likewise, by number
uniform int cut_outs;

layout(location = 0) out vec4 colour;  // alpha 0: the film does not show it
layout(location = 1) out float z;

const float nothing = 1e30;
const float least_share = 0.02;

float meets(vec4 plane, vec3 ray) {
    float towards = dot(plane.xyz, ray), at = plane.w / towards;
    return abs(towards) > 1e-9 && at > 0.0 ? at : nothing;
}

// Where the rig has a point of this pixel's line of sight; false: outside its picture.
bool place(vec2 pixel, float at, out vec2 uv) {
    vec4 q = pixel_from_target * vec4(pixel * at, at, 1.0);
    uv = (q.xy / max(q.z, 1e-6) + 0.5) / picture_size;
    vec2 inside = min(uv, 1.0 - uv);
    return q.z > 0.0 && min(inside.x, inside.y) >= 0.0;
}

void main() {
    vec2 pixel = gl_FragCoord.xy - 0.5, uv;
    vec3 ray = ray_from_pixel * vec3(pixel, 1.0);
    colour = vec4(0.0);
    z = 0.0;
    float behind = min(meets(floor_plane, ray), meets(back_plane, ray));
    if (behind < nothing && place(pixel, behind, uv)) {
        colour = vec4(textureLod(background_colour, uv, 0.0).rgb, 1.0);
        z = behind;
    }
    float nearest = nothing;
    vec4 front = vec4(0.0);
    for (int k = 0; k < cut_outs; ++k) {
        float at = meets(billboards[k], ray);
        if (at >= nearest || !place(pixel, at, uv)) continue;
        if (int(textureLod(numbers, uv, 0.0).r * 255.0 + 0.5) != k + 1) continue;
        float share = textureLod(matte, uv, 0.0).r;
        if (share < least_share) continue;
        nearest = at;
        front = vec4(textureLod(picture, uv, 0.0).rgb, share);
    }
    if (nearest == nothing || (colour.a == 0.0 && front.a < 0.5)) return;
    colour = vec4(colour.a > 0.0 ? mix(colour.rgb, front.rgb, front.a) : front.rgb, 1.0);
    if (front.a >= 0.5) z = nearest;
}
