// Level of detail from which on an image is minified and trilinear filtering is used.
const float smooth_from_lod = 0.7;

// Catmull-Rom interpolation by five bilinear fetches (the four corners' weights are negligible); trilinear where the
// picture is minified. Coordinates in 0..1.
vec3 sharp(sampler2D picture, vec2 uv, float lod) {
    if (lod > smooth_from_lod) return textureLod(picture, uv, lod).rgb;
    vec2 size = vec2(textureSize(picture, 0));
    vec2 at = uv * size - 0.5;
    vec2 f = fract(at);
    vec2 base = (floor(at) + 0.5) / size;
    vec2 w0 = f * (-0.5 + f * (1.0 - 0.5 * f));
    vec2 w1 = 1.0 + f * f * (-2.5 + 1.5 * f);
    vec2 w2 = f * (0.5 + f * (2.0 - 1.5 * f));
    vec2 w3 = f * f * (-0.5 + 0.5 * f);
    vec2 w12 = w1 + w2;
    vec2 t0 = base - 1.0 / size, t12 = base + w2 / w12 / size, t3 = base + 2.0 / size;
    vec3 sum = vec3(0.0);
    sum += textureLod(picture, vec2(t12.x, t0.y), 0.0).rgb * w12.x * w0.y;
    sum += textureLod(picture, vec2(t0.x, t12.y), 0.0).rgb * w0.x * w12.y;
    sum += textureLod(picture, t12, 0.0).rgb * w12.x * w12.y;
    sum += textureLod(picture, vec2(t3.x, t12.y), 0.0).rgb * w3.x * w12.y;
    sum += textureLod(picture, vec2(t12.x, t3.y), 0.0).rgb * w12.x * w3.y;
    float weight = w12.x * w0.y + w0.x * w12.y + w12.x * w12.y + w3.x * w12.y + w12.x * w3.y;
    return clamp(sum / weight, 0.0, 1.0);
}

vec3 bend(sampler2D picture, vec2 uv, vec2 along, vec3 middle) {
    return textureLod(picture, uv + along, 0.0).rgb + textureLod(picture, uv - along, 0.0).rgb - 2.0 * middle;
}

// Returns the correction that matches a colour's sharpness to the virtual camera's. Lens and sensor spread a point over as
// many pixels in either image, but the pixels of a source that sees the surface at a slant or from farther away cover
// more of it: to the second order the difference is one of second derivatives. `right` and `down` are a pixel
// of the virtual view in those of the source, `texel` one of the source in 0..1, `middle` the colour there.
vec3 respread(sampler2D picture, vec2 uv, vec2 texel, vec2 right, vec2 down, vec3 middle) {
    const float half_variance = 0.25;  // of the spread, px^2
    return half_variance * (bend(picture, uv, right * texel, middle) + bend(picture, uv, down * texel, middle) -
                            bend(picture, uv, vec2(texel.x, 0.0), middle) - bend(picture, uv, vec2(0.0, texel.y), middle));
}
