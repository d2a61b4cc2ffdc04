// Depth is all that is written.
void main() {}
