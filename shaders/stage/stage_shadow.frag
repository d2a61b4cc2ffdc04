// The shadow map needs depth alone.
void main() {}
