#include "host_app/foreground/foreground_depth.h"

#include "host_app/views/projection.h"
#include "host_app/views/tolerances.h"
#include "host_app/views/view_ranking.h"

namespace vantage {
namespace {

/// Instants from which on a rig's matte is used: after the first one it is always empty.
constexpr int min_learnt_instants = 2;
constexpr int block_px = 4;  // as in foreground_blocks.glsl

VirtualView depth_camera(const RigHistory& rig) {
    const cv::Size size = rig.depth().size();
    return {size.width, size.height, rig.K_depth(), rig.camera().world_from_camera};
}

}  // namespace

std::vector<const RigHistory*> ForegroundDepth::others_of(const RigHistory& rig,
                                                          std::span<RigHistory* const> all) {
    std::vector<const RigHistory*> others;
    for (const RigHistory* other : most_useful(all, depth_camera(rig), max_others + 1))
        if (other != &rig && other->learnt_instants() >= min_learnt_instants &&
            others.size() < max_others)
            others.push_back(other);
    return others;
}

void ForegroundDepth::set_others(Program& program, const RigHistory& rig,
                                 std::span<const RigHistory* const> others) {
    const VirtualView camera = depth_camera(rig);
    for (std::size_t i = 0; i < others.size(); ++i) {
        const RigHistory& other = *others[i];
        program.input("other_matte", i, other.matte());
        program.input("other_background", i, other.steady_depth());
        program.set("other_from_pixel", i,
                    Eigen::Matrix4f(pixel_from_target_pixel(other.camera(), camera).cast<float>()));
        program.set("other_size", i,
                    Eigen::Vector2f(static_cast<float>(other.colour().width_px()),
                                    static_cast<float>(other.colour().height_px())));
    }
}

void ForegroundDepth::carve(const RigHistory& rig, std::span<const RigHistory* const> others) {
    carved_.resize(rig.depth().size());
    TilePass& carving = carve_[others.size()];
    Program& carve = carving.use();
    carve.input("depth_map", rig.depth());
    carve.input("seen", rig.background_state().seen());
    carve.input("matte", rig.matte());
    set_others(carve, rig, others);
    carving.draw(carved_.target(), rig.matte_tiles(), rig.fresh_colour().size());
}

const Texture& ForegroundDepth::look_far(const RigHistory& rig,
                                         std::span<const RigHistory* const> others) {
    const cv::Size size = rig.depth().size();
    far_.resize({(size.width + block_px - 1) / block_px, (size.height + block_px - 1) / block_px});
    TilePass& looking = look_far_[others.size()];
    Program& look = looking.use();
    look.input("depth_map", carved_.texture());
    look.input("matte", rig.matte());
    set_others(look, rig, others);
    looking.draw(far_.target(), rig.matte_tiles(), rig.fresh_colour().size());
    return far_.texture();
}

void ForegroundDepth::close(const Texture& depth_m, const Texture* far_m, const RigHistory& rig,
                            const Framebuffer& closed) {
    TilePass& closing = far_m ? close_from_afar_ : close_;
    Program& close = closing.use();
    close.input("depth_map", depth_m);
    close.input("matte", rig.matte());
    close.input("background_depth", rig.steady_depth());
    close.set("edge_ratio", depth_edge_ratio);
    if (far_m) {
        close.input("far_depth", *far_m);
    }
    closing.draw(closed, rig.matte_tiles(), rig.fresh_colour().size());
}

void ForegroundDepth::find(const RigHistory& rig, std::span<RigHistory* const> all,
                           const Framebuffer& found) {
    const std::vector<const RigHistory*> others = others_of(rig, all);
    carve(rig, others);
    const Texture& far_m = look_far(rig, others);
    close(carved_.texture(), &far_m, rig, found);
}

void ForegroundDepth::better(const RigHistory& rig, std::span<RigHistory* const> all,
                             const Framebuffer& found) {
    const auto performers = [](const RigHistory& one) {
        return ComparedView{&one.camera(), &one.fresh_colour(), &one.foreground_depth(),
                            &one.samples()};
    };
    std::vector<ComparedView> views;
    for (const RigHistory* one : all) views.push_back(performers(*one));
    close(refinement_.refine_foreground(performers(rig), views, rig.matte_tiles()), nullptr, rig,
          found);
}

}  // namespace vantage
