#include "host_app/instants/performer_depth.h"

#include <fmt/format.h>

#include "host_app/instants/depth_edges.h"
#include "host_app/instants/projection.h"
#include "host_app/instants/view_ranking.h"

namespace vantage {
namespace {

/// Of one instant nothing is told: a matte is empty, whatever stands there.
constexpr int told_from_instants = 2;

}  // namespace

const Texture& PerformerDepth::carve(RigHistory& rig, std::span<RigHistory* const> all) {
    const cv::Size size = rig.depth().size();
    const VirtualView camera{size.width, size.height, rig.K_depth(),
                             rig.camera().world_from_camera};
    std::vector<RigHistory*> others;
    for (RigHistory* other : most_useful(all, camera, max_others + 1))
        if (other != &rig && other->learnt_instants() >= told_from_instants &&
            others.size() < max_others)
            others.push_back(other);
    carved_.resize(size);
    TilePass& carving = carve_[others.size()];
    Program& carve = carving.use();
    carve.set("depth_map", 0);
    carve.set("seen", 1);
    carve.set("matte", 2);
    rig.depth().bind(0);
    rig.set_state().seen().bind(1);
    rig.matte().texture().bind(2);
    int unit = 3;
    for (std::size_t i = 0; i < others.size(); ++i) {
        const auto set = [&](const char* name, const auto& value) {
            carve.set(fmt::format("{}[{}]", name, i), value);
        };
        RigHistory& other = *others[i];
        set("other_matte", unit);
        other.matte().texture().bind(unit++);
        set("other_set", unit);
        other.steady_depth().bind(unit++);
        set("other_from_pixel",
            Eigen::Matrix4f(pixel_from_target_pixel(other.camera(), camera).cast<float>()));
        set("other_size", Eigen::Vector2f(static_cast<float>(other.colour().width_px()),
                                          static_cast<float>(other.colour().height_px())));
    }
    carving.draw(carved_.target(), rig.matte_tiles().texture(), unit, rig.fresh_colour().size());
    return carved_.texture();
}

void PerformerDepth::close(const Texture& depth_m, const RigHistory& rig,
                           const Framebuffer& closed) {
    Program& depth = close_.use();
    depth.set("depth_map", 0);
    depth.set("matte", 1);
    depth.set("set_depth", 2);
    depth.set("edge_ratio", depth_edge_ratio);
    depth_m.bind(0);
    rig.matte().bind(1);
    rig.steady_depth().bind(2);
    close_.draw(closed, rig.matte_tiles(), 3, rig.fresh_colour().size());
}

void PerformerDepth::find(RigHistory& rig, std::span<RigHistory* const> all,
                          const Framebuffer& found) {
    close(carve(rig, all), rig, found);
}

void PerformerDepth::better(const RigHistory& rig, std::span<RigHistory* const> all,
                            const Framebuffer& found) {
    const auto performers = [](const RigHistory& one) {
        return ComparedView{&one.camera(), &one.fresh_colour(), &one.performer_depth(),
                            &one.samples()};
    };
    std::vector<ComparedView> views;
    for (const RigHistory* one : all) views.push_back(performers(*one));
    close(consensus_.better_performers(performers(rig), views, rig.matte_tiles()), rig, found);
}

}  // namespace vantage
