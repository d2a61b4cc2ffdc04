// Reduces a picture by up to twice TAPS in each direction: the mean of TAPS x TAPS bilinear samples that are spread
// evenly over what the pixel covers.
#ifndef TAPS
#define TAPS 1
#endif

uniform sampler2D picture;  // bilinear
uniform vec2 px_per_px;     // of the picture, for each pixel of the target

layout(location = 0) out vec4 reduced;

void main() {
    vec2 pitch = px_per_px / float(TAPS), first = (gl_FragCoord.xy - 0.5) * px_per_px + 0.5 * pitch;
    vec2 per_px = 1.0 / vec2(textureSize(picture, 0));
    vec4 sum = vec4(0.0);
    for (int y = 0; y < TAPS; ++y)
        for (int x = 0; x < TAPS; ++x) sum += textureLod(picture, (first + vec2(x, y) * pitch) * per_px, 0.0);
    reduced = sum / float(TAPS * TAPS);
}
