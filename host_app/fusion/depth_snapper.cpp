#include "host_app/fusion/depth_snapper.h"

namespace vantage {
namespace {

/// Depths that differ by more than this ratio lie on two surfaces.
constexpr float edge_ratio = 1.03f;

}  // namespace

DepthSnapper::DepthSnapper(const ShaderLibrary& library)
    : range_(library, "depth_range.frag"),
      snap_(library, "depth_snap.frag"),
      near_far_(TextureFormat::rg32f) {}

void DepthSnapper::snap(const Texture& depth_m, const Texture& colour, const Framebuffer& snapped) {
    near_far_.resize(depth_m.size());
    range_.use().set("depth_map", 0);
    depth_m.bind(0);
    range_.draw(near_far_.target());
    Program& program = snap_.use();
    program.set("depth_map", 0);
    program.set("near_far", 1);
    program.set("colour", 2);
    program.set("edge_ratio", edge_ratio);
    depth_m.bind(0);
    near_far_.texture().bind(1);
    colour.bind(2);
    snap_.draw(snapped);
}

}  // namespace vantage
