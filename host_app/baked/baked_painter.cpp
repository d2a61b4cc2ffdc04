#include "host_app/baked/baked_painter.h"

#include <algorithm>

#include "host_app/baked/background_probe.h"
#include "host_app/views/projection.h"

namespace vantage {
namespace {

constexpr double nearest_plane_m = 0.05;

}  // namespace

BakedPainter::BakedPainter(const ShaderLibrary& library)
    : program_(Program::render(library, "probe_tiles.vert", "probe_tiles.frag")) {}

const DepthPicture& BakedPainter::draw(const BakedBackground& background, const VirtualView& view,
                                       std::span<const std::string> rigs) {
    const cv::Size size(view.width_px, view.height_px);
    depth_test_.resize(size);
    picture_.resize(size, true, &depth_test_.texture());
    std::vector<const BackgroundProbe*> nearest;
    for (const auto& probe : background.probes) nearest.push_back(probe.get());
    std::sort(nearest.begin(), nearest.end(), [&](const auto* a, const auto* b) {
        return way_m(a->view(), view) < way_m(b->view(), view);
    });
    if (nearest.size() > most_probes) nearest.resize(most_probes);
    picture_.clear();
    glDepthMask(GL_TRUE);
    glClearDepthf(1.0f);
    glClear(GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    program_.use();
    vertices_.bind();
    // A further probe shows only what the nearer ones have not seen, and the nearest probe's
    // backdrop what none has seen.
    constexpr float range = 1.0f / (most_probes + 1);
    float begin = 0;
    for (const BackgroundProbe* probe : nearest) {
        glDepthRangef(begin, begin + range);
        draw(*probe, probe->surfaces(), view, rigs);
        begin += range;
    }
    glDepthRangef(begin, 1);
    if (!nearest.empty()) draw(*nearest.front(), nearest.front()->backdrop(), view, rigs);
    glDepthRangef(0, 1);
    glDisable(GL_DEPTH_TEST);
    return picture_;
}

void BakedPainter::draw(const BackgroundProbe& probe, const BackgroundProbe::Part& part,
                        const VirtualView& view, std::span<const std::string> rigs) {
    if (part.tiles == 0) return;
    program_.set(
        "clip_from_pixel",
        Eigen::Matrix4f((clip_from_target(view, nearest_plane_m) *
                         target_from_pixel(view, probe.view().world_from_camera, probe.view().K))
                            .cast<float>()));
    probe.vertices().bind(GL_ARRAY_BUFFER);
    probe.indices().bind(GL_ELEMENT_ARRAY_BUFFER);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(TileCorner), nullptr);
    program_.input("colour", part.colour);
    program_.input("inverse_depth", part.inverse_depth);
    program_.input("visibility", part.visibility);
    Eigen::Matrix4f layer_from_channel = Eigen::Matrix4f::Zero();
    for (std::size_t layer = 0; layer < rigs.size(); ++layer)
        for (std::size_t channel = 0; channel < probe.rigs().size(); ++channel)
            if (probe.rigs()[channel] == rigs[layer])
                layer_from_channel(static_cast<Eigen::Index>(layer),
                                   static_cast<Eigen::Index>(channel)) = 1;
    program_.set("layer_from_channel", layer_from_channel);
    program_.set("colour_cell_px", part.cell_px);
    program_.set("is_guessed", part.is_guessed ? 1 : 0);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(6 * part.tiles), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(6 * part.first_tile * sizeof(std::uint32_t)));
}

}  // namespace vantage
