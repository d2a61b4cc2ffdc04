// Catmull-Rom interpolation by five bilinear fetches (the four corners' weights are negligible); trilinear where the
// picture is minified. Coordinates in 0..1.
vec3 sharp(sampler2D picture, vec2 uv, float lod) {
    if (lod > 0.7) return textureLod(picture, uv, lod).rgb;
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
