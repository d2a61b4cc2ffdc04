#include "host_app/foreground/foreground_depth.h"

#include <fmt/format.h>

#include "host_app/views/depth_edges.h"
#include "host_app/views/projection.h"
#include "host_app/views/view_ranking.h"

namespace vantage {
namespace {

/// Of one instant nothing is told: a matte is empty, whatever stands there.
constexpr int told_from_instants = 2;
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
        if (other != &rig && other->learnt_instants() >= told_from_instants &&
            others.size() < max_others)
            others.push_back(other);
    return others;
}

GLuint ForegroundDepth::bind(Program& program, const RigHistory& rig,
                            std::span<const RigHistory* const> others, int unit) {
    const VirtualView camera = depth_camera(rig);
    for (std::size_t i = 0; i < others.size(); ++i) {
        const auto set = [&](const char* name, const auto& value) {
            program.set(fmt::format("{}[{}]", name, i), value);
        };
        const RigHistory& other = *others[i];
        set("other_matte", unit);
        other.matte().bind(unit++);
        set("other_background", unit);
        other.steady_depth().bind(unit++);
        set("other_from_pixel",
            Eigen::Matrix4f(pixel_from_target_pixel(other.camera(), camera).cast<float>()));
        set("other_size", Eigen::Vector2f(static_cast<float>(other.colour().width_px()),
                                          static_cast<float>(other.colour().height_px())));
    }
    return static_cast<GLuint>(unit);
}

void ForegroundDepth::carve(const RigHistory& rig, std::span<const RigHistory* const> others) {
    carved_.resize(rig.depth().size());
    TilePass& carving = carve_[others.size()];
    Program& carve = carving.use();
    carve.set("depth_map", 0);
    carve.set("seen", 1);
    carve.set("matte", 2);
    rig.depth().bind(0);
    rig.background_state().seen().bind(1);
    rig.matte().bind(2);
    carving.draw(carved_.target(), rig.matte_tiles(), bind(carve, rig, others, 3),
                 rig.fresh_colour().size());
}

const Texture& ForegroundDepth::look_far(const RigHistory& rig,
                                        std::span<const RigHistory* const> others) {
    const cv::Size size = rig.depth().size();
    far_.resize({(size.width + block_px - 1) / block_px, (size.height + block_px - 1) / block_px});
    TilePass& looking = look_far_[others.size()];
    Program& look = looking.use();
    look.set("depth_map", 0);
    look.set("matte", 1);
    carved_.texture().bind(0);
    rig.matte().bind(1);
    looking.draw(far_.target(), rig.matte_tiles(), bind(look, rig, others, 2),
                 rig.fresh_colour().size());
    return far_.texture();
}

void ForegroundDepth::close(const Texture& depth_m, const Texture* far_m, const RigHistory& rig,
                           const Framebuffer& closed) {
    TilePass& closing = far_m ? close_from_afar_ : close_;
    Program& close = closing.use();
    close.set("depth_map", 0);
    close.set("matte", 1);
    close.set("background_depth", 2);
    close.set("edge_ratio", depth_edge_ratio);
    depth_m.bind(0);
    rig.matte().bind(1);
    rig.steady_depth().bind(2);
    if (far_m) {
        close.set("far_depth", 3);
        far_m->bind(3);
    }
    closing.draw(closed, rig.matte_tiles(), 4, rig.fresh_colour().size());
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
