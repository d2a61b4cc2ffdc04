// How many rows lower than it should the right picture lies, -2 .. 2, by the sums of row_shift_votes.comp.
// Sized: NVIDIA's compiler takes the largest constant index for the end of an array without a size.
layout(std430, binding = 2) readonly buffer Votes { uint votes[5]; };

// Rows are left as they are unless another shift is better by a sixteenth.
int row_shift() {
    uint least = (votes[2] + 1u) / 16u * 15u;
    int shift = 0;
    for (int i = 0; i < 5; ++i) {
        uint sum = votes[i] + 1u;
        if (sum < least) {
            least = sum;
            shift = i - 2;
        }
    }
    return shift;
}
