// Winner takes all over the slices of a batch, and over the batches before it: the key of a pixel is
// (cost << 8) | disparity of the cheapest hypothesis so far, the smaller disparity at equal cost.
#ifndef GROUP_WIDTH
#define GROUP_WIDTH 64
#endif
layout(local_size_x = GROUP_WIDTH) in;
layout(std430, binding = 0) readonly buffer Costs { uvec4 costs[]; };
layout(std430, binding = 1) buffer Keys { uint keys[]; };
uniform ivec2 size;
uniform int slices;
uniform int first_disparity; // of slice 0; 0 starts the search afresh

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= size.x) return;
    int index = at.y * size.x + at.x;
    uint best = first_disparity == 0 ? 0xffffffffu : keys[index];
    uvec4 even = uvec4(0u, 2u, 4u, 6u) + uint(first_disparity);
    for (int slice = 0; slice < slices; ++slice) {
        uvec4 pairs = costs[slice * size.x * size.y + index];
        uvec4 low = ((pairs & 0xffffu) << 8) | even;
        uvec4 high = ((pairs >> 16) << 8) | (even + 1u);
        uvec4 smaller = min(low, high);
        best = min(best, min(min(smaller.x, smaller.y), min(smaller.z, smaller.w)));
        even += 8u;
    }
    keys[index] = best;
}
