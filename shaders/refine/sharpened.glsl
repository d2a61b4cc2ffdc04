// An image's pixel, sharpened for views that interpolate it bilinearly.
uniform float sharpening;  // share of the Laplacian that is subtracted; 0: the pixel as it is

vec3 sharpened(sampler2D image, ivec2 at) {
    vec3 own = texelFetch(image, at, 0).rgb;
    if (sharpening == 0.0) return own;
    ivec2 last = textureSize(image, 0) - 1;
    vec3 around = texelFetch(image, ivec2(max(at.x - 1, 0), at.y), 0).rgb + texelFetch(image, ivec2(min(at.x + 1, last.x), at.y), 0).rgb +
                  texelFetch(image, ivec2(at.x, max(at.y - 1, 0)), 0).rgb + texelFetch(image, ivec2(at.x, min(at.y + 1, last.y)), 0).rgb;
    return clamp(own - sharpening * (around - 4.0 * own), 0.0, 1.0);
}
