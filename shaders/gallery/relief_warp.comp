// One of the two 1-D passes of a relief texture's pre-warp (Oliveira et al., 2000): every line of a picture with depth
// (a row, or with COLUMNS a column of what the rows became) is moved along itself to where its points are seen, from the
// virtual camera's place, on the relief's plane. Nearer points are written after farther ones (McMillan's order, towards
// the epipole or from it), and what lies between two neighbours of one surface is interpolated.
#ifndef COLUMNS
#define COLUMNS 0
#endif
layout(local_size_x = 32) in;

uniform sampler2D colour;        // of the lines to move
uniform sampler2D depth_map;     // metres, 0 = unknown, negative = guessed; of the colour's size or smaller
uniform float focal_px, middle_px;  // of the rig along the lines
uniform float skew_per_line, skew_middle;  // px that a line is sheared for each line from that one
uniform float plane_m;           // depth of the relief's plane
uniform vec2 eye;                // of the virtual camera, along the lines and in depth, in the rig's coordinates, metres
uniform int margin;              // px that the result is wider by at both ends
uniform float edge_ratio;        // two depths whose ratio is larger lie on two surfaces

layout(rgba8, binding = 0) writeonly uniform highp image2D warped_colour;  // alpha 0 = nothing
layout(r32f, binding = 1) writeonly uniform highp image2D warped_m;        // depth from the rig, 0 = nothing

const float rounding = 1e-3;    // px that places may be off
const int widest_gap_px = 256;  // between neighbours of one surface

ivec2 place(int line, int along) { return COLUMNS == 1 ? ivec2(line, along) : ivec2(along, line); }

void put(int line, int along, vec4 c, float z) {
    int length = COLUMNS == 1 ? imageSize(warped_m).y : imageSize(warped_m).x;
    along += margin;
    if (along < 0 || along >= length) return;
    imageStore(warped_colour, place(line, along), c);
    imageStore(warped_m, place(line, along), vec4(z));
}

float depth_at(ivec2 at) {
    vec2 uv = (vec2(at) + 0.5) / vec2(textureSize(colour, 0));
    ivec2 map = textureSize(depth_map, 0);
    return abs(texelFetch(depth_map, min(ivec2(uv * vec2(map)), map - 1), 0).r);
}

// Where a point of the rig's picture is seen on the plane, px along the line.
float warped(float along, float z) {
    float point = z * (along - middle_px) / focal_px;
    float seen = (plane_m - eye.y) * (point - eye.x) / (z - eye.y) + eye.x;
    return middle_px + focal_px * seen / plane_m;
}

void scan(int line, int from, int to, int by, float skew) {
    float before = 0.0, before_z = 0.0;
    vec4 before_c = vec4(0.0);
    for (int at = from; (to - at) * by >= 0; at += by) {
        float z = depth_at(place(line, at));
        if (z <= max(eye.y, 0.0) * 1.001) {
            before_z = 0.0;
            continue;
        }
        vec4 c = texelFetch(colour, place(line, at), 0);
        if (c.a == 0.0) {
            before_z = 0.0;
            continue;
        }
        float here = warped(float(at) - skew, z);
        bool goes_on = before_z > 0.0 && max(z, before_z) < edge_ratio * min(z, before_z) && (here - before) * float(by) > 0.0;
        if (!goes_on) {
            put(line, int(floor(here + 0.5)), c, z);
        } else {
            int first = int(ceil(min(here, before) - rounding)), last = min(int(floor(max(here, before) + rounding)), first + widest_gap_px);
            for (int i = first; i <= last; ++i) {
                float t = (float(i) - before) / (here - before);
                put(line, i, mix(before_c, c, t), mix(before_z, z, t));
            }
        }
        before = here;
        before_z = z;
        before_c = c;
    }
}

void main() {
    int line = int(gl_GlobalInvocationID.x);
    ivec2 from = textureSize(colour, 0);
    int lines = COLUMNS == 1 ? from.x : from.y, length = COLUMNS == 1 ? from.y : from.x;
    if (line >= lines) return;
    int warped_length = COLUMNS == 1 ? imageSize(warped_m).y : imageSize(warped_m).x;
    for (int i = 0; i < warped_length; ++i) put(line, i - margin, vec4(0.0), 0.0);
    float skew = skew_per_line * (float(line) - skew_middle);
    // Before the rig, the camera draws nearer points towards the epipole; behind it, away from there.
    bool towards = eye.y > 0.0;
    float epipole = abs(eye.y) > 1e-6 * plane_m ? middle_px + focal_px * eye.x / eye.y + skew : eye.x > 0.0 == towards ? 1e9 : -1e9;
    int split = int(clamp(epipole, -1.0, float(length)));
    if (towards) {
        scan(line, 0, min(split, length - 1), 1, skew);
        scan(line, length - 1, max(split + 1, 0), -1, skew);
    } else {
        scan(line, max(split, 0), length - 1, 1, skew);
        scan(line, min(split, length) - 1, 0, -1, skew);
    }
}
