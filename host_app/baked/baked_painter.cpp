#include "host_app/baked/baked_painter.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "host_app/views/projection.h"

namespace vantage {
namespace {

/// The part of the depth buffer for measured surfaces; inpainted ones lie behind all of them.
constexpr float measured_range = 0.5f;

/// Pictures that are blended at a pixel: of all rigs that a part names, or at low cost.
constexpr std::size_t sharp_sources = 4, plain_sources = 3;

/// The channels of a part's weights that are drawn, the owner's first and then those of the rigs
/// that look from closest to the target.
std::vector<std::size_t> drawn_channels(const BakedSurface& background,
                                        const BakedSurface::Part& part, const VirtualView& target,
                                        std::size_t at_most) {
    const auto apart_m = [&](std::size_t channel) {
        const auto view = static_cast<std::size_t>(part.sources[channel]);
        return (background.views()[view].camera.world_from_camera.translation() -
                target.world_from_camera.translation())
            .norm();
    };
    std::vector<std::size_t> channels;
    for (std::size_t k = 0; k < part.sources.size(); ++k)
        if (part.sources[k] >= 0) channels.push_back(k);
    std::stable_sort(channels.begin() + 1, channels.end(),
                     [&](std::size_t a, std::size_t b) { return apart_m(a) < apart_m(b); });
    if (channels.size() > at_most) channels.resize(at_most);
    return channels;
}

/// The level of detail at which a pixel of the source is about one of the target, at the middle of
/// a part.
float level_of_detail(const BakedSurface::Part& part, const VirtualView& source,
                      const VirtualView& target) {
    const auto depth_m = [&](const VirtualView& view) {
        return std::max((view.world_from_camera.inverse() * part.middle).z(), 1e-3);
    };
    const double pixels = source.K(0, 0) / depth_m(source) / (target.K(0, 0) / depth_m(target));
    return static_cast<float>(std::log2(std::max(pixels, 1.0)));
}

}  // namespace

BakedPainter::BakedPainter(const ShaderLibrary& library) : library_(&library) {
    for (const bool is_plain : {false, true}) (void)program_of(is_plain, false);
}

Program& BakedPainter::program_of(bool is_plain, bool has_origins) {
    std::optional<Program>& program = programs_[is_plain ? 1 : 0][has_origins ? 1 : 0];
    if (!program)
        program.emplace(Program::render(
            *library_, "baked.vert", "baked.frag",
            {{"PLAIN", is_plain ? "1" : "0"},
             {"ORIGINS", has_origins ? "1" : "0"},
             {"SOURCES", std::to_string(is_plain ? plain_sources : sharp_sources)}}));
    return *program;
}

const DepthPicture& BakedPainter::draw(const BakedInstant& instant, const VirtualView& target,
                                       double near_m, std::span<const std::string> origins,
                                       bool is_plain, float remembered_alpha) {
    const cv::Size size(target.width_px, target.height_px);
    depth_.resize(size);
    picture_.resize(size, !origins.empty(), &depth_.texture());
    Program& program = program_of(is_plain, !origins.empty());
    picture_.clear();
    glDepthMask(GL_TRUE);
    glClearDepthf(1.0f);
    glClear(GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_BACK);
    glFrontFace(GL_CCW);
    glDisable(GL_BLEND);
    program.use();
    program.set("remembered_confidence", RigSurface::remembered_confidence);
    program.set("remembered_alpha", remembered_alpha);
    vertices_.bind();
    glEnableVertexAttribArray(0);
    for (const BakedSurface::Part& part : instant.background->parts())
        draw_part(instant, part, target, near_m, origins, is_plain ? plain_sources : sharp_sources,
                  program);
    glDisableVertexAttribArray(0);
    glDepthRangef(0, 1);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    return picture_;
}

void BakedPainter::draw_part(const BakedInstant& instant, const BakedSurface::Part& part,
                             const VirtualView& target, double near_m,
                             std::span<const std::string> origins, std::size_t sources,
                             Program& program) {
    const std::vector<BakedSurface::View>& views = instant.background->views();
    const Eigen::Matrix4d target_from_owner =
        target_from_pixel(target, part.world_from_owner, part.K);
    program.set(
        "clip_from_pixel",
        Eigen::Matrix4f((clip_from_target(target, near_m) * target_from_owner).cast<float>()));
    program.set("target_from_pixel", Eigen::Matrix4f(target_from_owner.cast<float>()));
    const Pose target_from_world = target.world_from_camera.inverse();
    const std::vector<std::size_t> channels =
        drawn_channels(*instant.background, part, target, sources);
    Eigen::Matrix4f source_from_channel = Eigen::Matrix4f::Zero();
    Eigen::Matrix4f origin_from_picture = Eigen::Matrix4f::Zero();
    for (std::size_t k = 0; k < sources; ++k) {
        // A picture too few is the owner's, with no weight.
        const bool is_drawn = k < channels.size();
        const std::size_t channel = channels[is_drawn ? k : 0];
        const auto at = static_cast<std::size_t>(part.sources[channel]);
        const BakedSurface::View& view = views[at];
        if (is_drawn)
            source_from_channel(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(channel)) =
                1;
        for (std::size_t i = 0; i < std::min<std::size_t>(4, origins.size()); ++i)
            if (is_drawn && origins[i] == view.camera.name)
                origin_from_picture(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = 1;
        const RigSurface* live = instant.colours[at].get();
        const Texture& colour = live ? live->colour() : view.colour;
        const VirtualView source{colour.width_px(), colour.height_px(), view.camera.K,
                                 view.camera.world_from_camera};
        // Places in the picture as shares of its sides.
        Eigen::Matrix4d share_from_pixel = Eigen::Matrix4d::Identity();
        share_from_pixel(0, 0) = 1.0 / source.width_px;
        share_from_pixel(1, 1) = 1.0 / source.height_px;
        share_from_pixel(0, 2) = 0.5 / source.width_px;
        share_from_pixel(1, 2) = 0.5 / source.height_px;
        Eigen::Matrix4d pixel_from_camera = Eigen::Matrix4d::Identity();
        pixel_from_camera.topLeftCorner<3, 3>() = source.K;
        program.set("source_from_pixel", k,
                    Eigen::Matrix4f(
                        (share_from_pixel * pixel_from_camera *
                         target_from_pixel({source.width_px, source.height_px,
                                            Eigen::Matrix3d::Identity(), source.world_from_camera},
                                           part.world_from_owner, part.K))
                            .cast<float>()));
        program.set(
            "centre", k,
            Eigen::Vector3f(
                (target_from_world * source.world_from_camera.translation().eval()).cast<float>()));
        program.set("presence", k, is_drawn ? 1.0f : 0.0f);
        program.set("lod", k, level_of_detail(part, source, target));
        program.input("colour", k, colour);
    }
    program.input("weights", part.weights);
    program.set("source_from_channel", source_from_channel);
    program.set("origin_from_picture", origin_from_picture);
    part.vertices.bind(GL_ARRAY_BUFFER);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    part.indices.bind(GL_ELEMENT_ARRAY_BUFFER);
    const auto draw = [&](int first, int last, bool is_inpainted) {
        if (first == last) return;
        if (is_inpainted)
            glDepthRangef(measured_range, 1);
        else
            glDepthRangef(0, measured_range);
        program.set("is_known", is_inpainted ? 0.0f : 1.0f);
        glDrawElements(GL_TRIANGLES, last - first, GL_UNSIGNED_INT,
                       reinterpret_cast<const void*>(static_cast<std::uintptr_t>(first) *
                                                     sizeof(std::uint32_t)));
    };
    draw(0, part.measured, false);
    draw(part.measured, part.all, true);
}

}  // namespace vantage
