// Depth along the camera's z axis in metres, as the bits of a float: clip space keeps it in w.
layout(location = 0) out uint depth_bits;

void main() {
    depth_bits = floatBitsToUint(1.0 / gl_FragCoord.w);
}
