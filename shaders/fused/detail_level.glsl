// Level of detail at which one source pixel is about one pixel of the virtual view.
float detail_level(mat4 source_from_target, float z, float source_z) {
    return log2(max(length(source_from_target[0].xyz) * z / source_z, 1.0));
}
