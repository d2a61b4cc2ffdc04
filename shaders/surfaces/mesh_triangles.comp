// Builds the triangles of a depth map's quad grid, cut where neighbouring pixels lie on different surfaces; one invocation
// for each block of quads. Quads of several pixels that are cut become quads of one pixel. A block, or a quarter of one, in
// which inverse depth is linear in the picture, as on a plane, becomes two triangles.
#ifndef STEP
#define STEP 1    // px of the depth map that a quad spans
#endif
#ifndef ACROSS
#define ACROSS 1  // quads of a block, across and down
#endif
#ifndef TILES
#define TILES 0   // 1: only in selected tiles
#endif
#include "mesh_joints.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, binding = 0) writeonly buffer Triangles { uint indices[]; };
layout(std430, binding = 1) buffer Command { uint count; };  // the first word of an indirect draw

#if TILES
uniform sampler2D tiles;  // 0 = not selected
uniform vec2 tile_share;  // of the picture
#endif
uniform float bend;       // of inverse depth, below which a block is flat

void write(uint first, uvec3 corners) {
    indices[first] = corners.x;
    indices[first + 1u] = corners.y;
    indices[first + 2u] = corners.z;
}

bool is_whole(Quad q) { return q.ab && q.cd && q.ac && q.bd; }

void write_quad(Quad q, ivec2 at, int width, ivec2 size) {
    uint first = uint(at.y * size.x + at.x);
    uint down = uint(width * size.x), across = uint(width);
    uvec4 corner = uvec4(first, first + across, first + down, first + down + across);
    bool whole = is_whole(q);
    // The diagonal along which the surface bends less.
    bool falls = abs(q.a - q.d) < abs(q.b - q.c);
    uvec3 upper = falls ? corner.xyw : corner.xyz, lower = falls ? corner.xwz : corner.ywz;
    if (!whole) {
        if (q.ab && q.ac)
            upper = corner.xyz;
        else if (q.bd && q.cd)
            upper = corner.ywz;
        else if (q.ab && q.bd)
            upper = corner.xyw;
        else if (q.ac && q.cd)
            upper = corner.xwz;
        else
            return;
    }
    uint place = atomicAdd(count, whole ? 6u : 3u);
    write(place, upper);
    if (whole) write(place + 3u, lower);
}

#if ACROSS > 1
// Writes a block of `side` pixels as two triangles if samples at every second pixel show that it is flat. They extend a
// pixel beyond it on all sides, so that no gap shows beside a block that is not flat.
bool write_if_flat(ivec2 at, int side, ivec2 size) {
    int samples = (side + 2) / 2;
    ivec2 low = max(at - 1, 0), high = min(at + side + 1, size - 1);
    float a = inverse_depth(low, size), b = inverse_depth(ivec2(high.x, low.y), size);
    float c = inverse_depth(ivec2(low.x, high.y), size), d = inverse_depth(high, size);
    if (min(min(a, b), min(c, d)) <= 0.0) return false;
    for (int j = 0; j <= samples; ++j)
        for (int i = 0; i <= samples; ++i) {
            ivec2 sample_at = ivec2(mix(vec2(low), vec2(high), vec2(i, j) / float(samples)) + 0.5);
            vec2 share = vec2(sample_at - low) / vec2(high - low);
            float expected = mix(mix(a, b, share.x), mix(c, d, share.x), share.y);
            if (abs(inverse_depth(sample_at, size) - expected) > bend) return false;
        }
    uint first = uint(low.y * size.x + low.x), below = uint(high.y * size.x + low.x), right = uint(high.x - low.x);
    uint place = atomicAdd(count, 6u);
    write(place, uvec3(first, first + right, below));
    write(place + 3u, uvec3(first + right, below + right, below));
    return true;
}

const int half_across = ACROSS / 2;
const uint lanes = gl_WorkGroupSize.x * gl_WorkGroupSize.y, quads = uint(half_across * half_across);
// Work lists of a work group: quarters of the blocks that are not flat, those of them that are not flat either, and cut
// quads. They are short, which saves time on a software rasteriser, which executes all branches for all of its lanes.
shared uint quarters[4u * lanes], bent[4u * lanes], cut[quads * 4u * lanes];
shared uint quarter_count, bent_count, cut_count;

uint word_of(ivec2 at) { return uint(at.x) | uint(at.y) << 16; }
ivec2 place_of(uint word) { return ivec2(word & 0xffffu, word >> 16); }
#endif

void main() {
    ivec2 size = textureSize(depth_map, 0);
    ivec2 at = ivec2(gl_GlobalInvocationID.xy) * ACROSS * STEP, end = (size - 1) / STEP * STEP;
    bool is_inside = at.x < end.x && at.y < end.y;
#if TILES
    vec2 middle = (vec2(at) + 0.5 * float(ACROSS * STEP)) / vec2(size);
    is_inside = is_inside && texelFetch(tiles, ivec2(middle / tile_share), 0).r > 0.0;
#endif
#if ACROSS > 1
    uint lane = gl_LocalInvocationIndex;
    if (lane == 0u) quarter_count = bent_count = cut_count = 0u;
    barrier();
    if (is_inside && !write_if_flat(at, ACROSS * STEP, size)) {
        uint place = atomicAdd(quarter_count, 4u);
        for (int part = 0; part < 4; ++part)
            quarters[place + uint(part)] = word_of(at + half_across * STEP * ivec2(part & 1, part >> 1));
    }
    barrier();
    for (uint i = lane; i < quarter_count; i += lanes) {
        ivec2 quarter = place_of(quarters[i]);
        if (quarter.x < end.x && quarter.y < end.y && !write_if_flat(quarter, half_across * STEP, size))
            bent[atomicAdd(bent_count, 1u)] = quarters[i];
    }
    barrier();
    for (uint i = lane; i < quads * bent_count; i += lanes) {
        int k = int(i % quads);
        ivec2 quad = place_of(bent[i / quads]) + STEP * ivec2(k % half_across, k / half_across);
        if (quad.x >= end.x || quad.y >= end.y) continue;
        Quad q = quad_at(quad, STEP, size);
        if (is_whole(q))
            write_quad(q, quad, STEP, size);
        else
            cut[atomicAdd(cut_count, 1u)] = word_of(quad);
    }
    barrier();
    // The quads of a cut quad's pixels are cut closer to the edge.
    const uint parts = uint(STEP * STEP);
    for (uint i = lane; i < parts * cut_count; i += lanes) {
        int k = int(i % parts);
        ivec2 part = place_of(cut[i / parts]) + ivec2(k % STEP, k / STEP);
        write_quad(quad_at(part, 1, size), part, 1, size);
    }
#else
    if (is_inside) write_quad(quad_at(at, STEP, size), at, STEP, size);
#endif
}
