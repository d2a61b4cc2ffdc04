// Converts a camera's colours to the stage's: encode(matrix * decode(camera) ^ tone), with sRGB's transfer
// function. The CPU reference is ColourCorrection::apply.
uniform sampler2D camera;       // rgba8, sRGB-coded
uniform mat3 stage_from_camera; // linear light
uniform vec3 tone;
layout(location = 0) out vec4 stage;

vec3 decode(vec3 coded) {
    return mix(pow((coded + 0.055) / 1.055, vec3(2.4)), coded / 12.92, vec3(lessThanEqual(coded, vec3(0.04045))));
}

vec3 encode(vec3 linear) {
    return mix(1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, linear * 12.92,
               vec3(lessThanEqual(linear, vec3(0.0031308))));
}

void main() {
    vec4 coded = texelFetch(camera, ivec2(gl_FragCoord.xy), 0);
    vec3 linear = stage_from_camera * pow(decode(coded.rgb), tone);
    stage = vec4(encode(clamp(linear, 0.0, 1.0)), coded.a);
}
