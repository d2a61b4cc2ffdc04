// Paths of the fill: a word a cell, the disparity that has come to it | the cost of the path it came along << 16, where
// each step costs what the cells differ in luma and colour, and a little for itself. A source, where paths begin, costs
// nothing; beyond the picture is 0, which nothing changes.
const uint unreached = 0x7fff0000u;  // nothing has come
const uint step_cost = 4u;

// A disparity may come to a cell that the other camera could not see at that disparity: either something nearer hides it
// there (no more than the cell's limit), or it lies beyond that camera's border.
uint advanced(uint here, uint from, uint cell, uint from_cell, uint border) {
    uint d = from & 0xffffu;
    int luma = int((cell >> 16) & 255u) - int((from_cell >> 16) & 255u), colour = int(cell >> 24) - int(from_cell >> 24);
    uint came = from + ((step_cost + uint(abs(luma) + abs(colour))) << 16);
    return d - 1u < (cell & 0xffffu) || d >= border ? min(here, came) : here;
}
uvec4 advanced(uvec4 here, uvec4 from, uvec4 cell, uvec4 from_cell, uvec4 border) {
    uvec4 d = from & 0xffffu;
    ivec4 luma = ivec4((cell >> 16) & 255u) - ivec4((from_cell >> 16) & 255u);
    ivec4 colour = ivec4(cell >> 24) - ivec4(from_cell >> 24);
    uvec4 came = from + ((step_cost + uvec4(abs(luma) + abs(colour))) << 16);
    uvec4 refused = uvec4(greaterThanEqual(d - 1u, cell & 0xffffu)) * uvec4(lessThan(d, border));
    return min(here, max(came, refused * ~0u));
}
