#include "host_app/refine/multi_view_refinement.h"

#include <cmath>

#include <Eigen/LU>
#include <fmt/format.h>

#include "host_app/views/depth_edges.h"
#include "host_app/views/depth_spread.h"
#include "host_app/views/projection.h"
#include "host_app/views/view_ranking.h"

namespace vantage {
namespace {

/// Surfaces of two rigs that are nearer to each other than this share of their depth are one.
constexpr float agreeing_softness = 0.02f;
/// Other rigs tell something new from this many of a rig's own parallaxes on.
constexpr double least_news = 2;
/// Steps of the two sweeps: parallax in pixels of the depth map.
constexpr double coarse_step_px = 2, fine_step_px = 1;
/// Parallax that does not show, and that depth is not moved for.
constexpr double exact_px = 0.7, least_change_px = 0.5;
/// Of all points, those that lie on a floor that can be seen.
constexpr double floor_share = 0.05;
/// Relative uncertainty of depth that does not come of stereo.
constexpr double least_sigma = 0.002;

/// The view's camera for a depth map of some size.
VirtualView depth_camera(const ComparedView& view, cv::Size size) {
    return {size.width, size.height,
            scaled_intrinsics(view.camera().K,
                              static_cast<double>(size.width) / view.colour->width_px(),
                              static_cast<double>(size.height) / view.colour->height_px()),
            view.camera().world_from_camera};
}

double own_parallax_px(const ComparedView& view) {
    const double z = view.median_depth_m();
    return z > 0 ? view.K_depth()(0, 0) * view.camera().baseline_m / z : 0;
}

}  // namespace

Eigen::Matrix3d ComparedView::K_depth() const {
    return scaled_intrinsics(seen_by->K,
                             static_cast<double>(depth_m->width_px()) / colour->width_px(),
                             static_cast<double>(depth_m->height_px()) / colour->height_px());
}

ComparedView compared(const RigHistory& rig) {
    return {&rig.camera(), &rig.colour(), &rig.steady_depth(), &rig.samples()};
}

std::vector<ComparedView> compared(std::span<RigHistory* const> rigs) {
    std::vector<ComparedView> all;
    for (const RigHistory* rig : rigs) all.push_back(compared(*rig));
    return all;
}

bool shows_floor(std::span<const ComparedView> views) {
    std::size_t all = 0, on_floor = 0;
    for (const ComparedView& view : views) {
        const Pose& pose = view.camera().world_from_camera;
        const double spread = static_cast<double>(depth_spread(view.camera()));
        for (const Eigen::Vector3d& point_m : view.sample_points_m()) {
            const Eigen::Vector3d away_m = point_m - pose.translation();
            const double z_m = pose.linear().col(2).dot(away_m);
            const double sigma_m = std::abs(away_m.y()) * std::max(z_m * spread, least_sigma);
            ++all;
            if (std::abs(point_m.y()) < sigma_m) ++on_floor;
        }
    }
    return static_cast<double>(on_floor) > floor_share * static_cast<double>(all);
}

MultiViewRefinement::Sweep::Sweep(cv::Size size)
    : cost{Texture(TextureFormat::rgba8, size.width, size.height),
             Texture(TextureFormat::rgba8, size.width, size.height),
             Texture(TextureFormat::rgba8, size.width, size.height),
             Texture(TextureFormat::rgba8, size.width, size.height)},
      target({&cost[0], &cost[1], &cost[2], &cost[3]}) {}

MultiViewRefinement::MultiViewRefinement(const ShaderLibrary& library)
    : halve_(library, "rig_smooth.frag", {{"SCALE", "2"}}),
      smooth_(library, "rig_smooth.frag"),
      refine_(library, "rig_refine.frag") {
    for (std::size_t others = 1; others <= max_others; ++others) {
        const std::pair<std::string, std::string> count{"OTHERS", std::to_string(others)};
        sweep_.emplace_back(library, "rig_sweep.frag", ShaderDefines{count});
        agreement_pass_.emplace_back(library, "rig_agreement.frag", ShaderDefines{count});
        carve_.emplace_back(library, "rig_carve.frag", ShaderDefines{count, {"MOVES", "0"}});
        move_and_carve_.emplace_back(library, "rig_carve.frag",
                                     ShaderDefines{count, {"MOVES", "1"}});
        adopt_.emplace_back(library, "rig_adopt.frag", ShaderDefines{count});
        floor_.emplace_back(library, "rig_floor.frag", ShaderDefines{count});
    }
    whole_.upload(cv::Mat1b(1, 1, uchar{255}));
}

std::deque<MultiViewRefinement::Step> MultiViewRefinement::in_steps(const std::function<void()>& work) {
    std::deque<Step> steps;
    steps_ = &steps;
    work();
    steps_ = nullptr;
    return steps;
}

void MultiViewRefinement::then(Step step) {
    if (steps_)
        steps_->push_back(std::move(step));
    else
        step();
}

void MultiViewRefinement::draw(TilePass& pass, const Framebuffer& target, int unit, const Look& look) {
    pass.draw(target, *look->tiles, static_cast<GLuint>(unit), look->picture);
}

void MultiViewRefinement::bind_view(Program& program, const Texture& depth_m,
                             const ComparedView& view) const {
    program.set("depth_map", 0);
    program.set("picture", 1);
    program.set("edge_ratio", depth_edge_ratio);
    depth_m.bind(0);
    view.colour->bind(1);
}

int MultiViewRefinement::bind_others(Program& program, const Texture& depth_m, const Look& look) const {
    const ComparedView& view = look->view;
    bind_view(program, depth_m, view);
    const VirtualView camera = depth_camera(view, depth_m.size());
    program.set("spread", depth_spread(view.camera()));
    int unit = 2;
    for (std::size_t i = 0; i < look->others.size(); ++i) {
        const ComparedView& other = look->others[i];
        const auto set = [&](const char* name, const auto& value) {
            program.set(fmt::format("{}[{}]", name, i), value);
        };
        set("other_depth", unit);
        other.depth_m->bind(unit++);
        set("other_colour", unit);
        other.colour->bind(unit++);
        set("other_from_pixel",
            Eigen::Matrix4f(pixel_from_target_pixel(other.camera(), camera).cast<float>()));
        set("other_size", Eigen::Vector2f(static_cast<float>(other.colour->width_px()),
                                          static_cast<float>(other.colour->height_px())));
        set("other_spread", depth_spread(other.camera()));
    }
    return unit;
}

double MultiViewRefinement::parallax_px(const Look& look) {
    constexpr double small = 0.01;
    const ComparedView& view = look->view;
    const VirtualView camera = depth_camera(view, view.depth_m->size());
    const double z = view.median_depth_m();
    double largest = 0;
    for (const ComparedView& other : look->others) {
        const Eigen::Matrix4d map = pixel_from_target_pixel(other.camera(), camera);
        const auto project = [&](double depth_m) {
            const Eigen::Vector4d q =
                map * Eigen::Vector4d(0.5 * camera.width_px * depth_m,
                                      0.5 * camera.height_px * depth_m, depth_m, 1);
            return Eigen::Vector2d(q.head<2>() / q.z());
        };
        const double moved_px = (project(z * (1 + small)) - project(z)).norm() / small;
        if (std::isfinite(moved_px)) largest = std::max(largest, moved_px);
    }
    return largest;
}

bool MultiViewRefinement::tell_news(const ComparedView& view, double parallax_px) {
    const double own_px = own_parallax_px(view);
    return own_px > 0 && parallax_px > least_news * own_px;
}

void MultiViewRefinement::smooth(TilePass& pass, const Texture& depth_m, const Look& look,
                          const Framebuffer& target) const {
    bind_view(pass.use(), depth_m, look->view);
    draw(pass, target, 2, look);
}

void MultiViewRefinement::sweep(const Look& look, double relative_step) {
    const ComparedView& view = look->view;
    const cv::Size size = half_.texture().size();
    // Asked for before anything is bound: making a texture binds it.
    const Framebuffer& refined = half_.next_target(size);
    TilePass& comparing = sweep_[look->others.size() - 1];
    Program& compare = comparing.use();
    const int unit = bind_others(compare, half_.texture(), look);
    compare.set("relative_step", static_cast<float>(relative_step));
    compare.set("lod", std::log2(static_cast<float>(view.colour->width_px()) /
                                 static_cast<float>(size.width)));
    draw(comparing, costs_->target, unit, look);

    Program& refine = refine_.use();
    bind_view(refine, half_.texture(), view);
    refine.set("relative_step", static_cast<float>(relative_step));
    for (int i = 0; i < 4; ++i) {
        refine.set(fmt::format("costs[{}]", i), 2 + i);
        costs_->cost[static_cast<std::size_t>(i)].bind(2 + i);
    }
    draw(refine_, refined, 6, look);
    half_.finish();
}

void MultiViewRefinement::refine(const Look& look, double parallax_px) {
    const cv::Size size = look->view.depth_m->size(),
                   half((size.width + 1) / 2, (size.height + 1) / 2);
    then([=, this] {
        half_before_.resize(half);
        if (!costs_ || costs_->cost[0].size() != half) costs_ = std::make_unique<Sweep>(half);
        smooth(halve_, *look->view.depth_m, look, half_before_.target());
        smooth(smooth_, half_before_.texture(), look, half_.next_target(half));
        half_.finish();
    });
    then([=, this] { sweep(look, coarse_step_px / parallax_px); });
    then([=, this] {
        smooth(smooth_, half_.texture(), look, half_.next_target(half));
        half_.finish();
        sweep(look, fine_step_px / parallax_px);
    });
}

void MultiViewRefinement::compare(const Look& look, double parallax_px) {
    const Texture& depth_m = *look->view.depth_m;
    agreement_.resize({(depth_m.width_px() + 1) / 2, (depth_m.height_px() + 1) / 2});
    TilePass& comparing = agreement_pass_[look->others.size() - 1];
    Program& agreement = comparing.use();
    const int unit = bind_others(agreement, depth_m, look);
    agreement.set("exact", static_cast<float>(exact_px / std::max(parallax_px, 1.0)));
    draw(comparing, agreement_.target(), unit, look);
    agreement_.generate_mipmaps();
}

MultiViewRefinement::Look MultiViewRefinement::look_at(const ComparedView& view,
                                         std::span<const ComparedView> all, std::size_t most,
                                         const Texture* tiles) const {
    std::vector<const ComparedView*> looked_at;
    for (const ComparedView& one : all)
        if (one.seen_by != view.seen_by) looked_at.push_back(&one);
    auto look = std::make_shared<LookedAt>();
    look->view = view;
    for (const ComparedView* other :
         most_useful(looked_at, depth_camera(view, view.depth_m->size()), most))
        look->others.push_back(*other);
    look->tiles = tiles ? tiles : &whole_;
    look->picture = tiles ? view.colour->size() : cv::Size(TilePass::side_px, TilePass::side_px);
    return look;
}

const Texture& MultiViewRefinement::move_and_carve(const Look& look) {
    const Texture& depth_m = *look->view.depth_m;
    if (look->others.empty()) return depth_m;
    // Before anything is bound: making a texture binds it.
    result_.resize(depth_m.size());
    judged_.resize(depth_m.size());

    const double parallax = parallax_px(look);
    const bool doubts = !look->view.is_matched, moves = tell_news(look->view, parallax);
    const Texture& carved = moves ? judged_.texture() : result_.texture();
    if (doubts) then([=, this] { compare(look, parallax); });
    if (doubts && moves) refine(look, parallax);
    then([=, this] {
        TilePass& carving = (moves ? move_and_carve_ : carve_)[look->others.size() - 1];
        Program& carve = carving.use();
        int unit = bind_others(carve, *look->view.depth_m, look);
        carve.set("softness", agreeing_softness);
        carve.set("doubts", doubts);
        // What a program may read must not be what it draws, even where it does not read it.
        const auto read_if_doubted = [&](const char* name, const auto& drawn) {
            carve.set(name, doubts ? unit : 0);
            if (doubts) drawn.texture().bind(unit++);
        };
        read_if_doubted("agreement", agreement_);
        if (moves) {
            read_if_doubted("half_before", half_before_);
            read_if_doubted("half_after", half_);
            carve.set("least_change", static_cast<float>(least_change_px / parallax));
        }
        draw(carving, moves ? judged_.target() : result_.target(), unit, look);
    });
    return carved;
}

const Texture& MultiViewRefinement::better(const Look& look) {
    const Texture& judged = move_and_carve(look);
    if (look->others.empty() || &judged == &result_.texture()) return judged;
    then([=, this] {
        TilePass& adopting = adopt_[look->others.size() - 1];
        Program& adopt = adopting.use();
        const int unit = bind_others(adopt, *look->view.depth_m, look);
        adopt.set("softness", agreeing_softness);
        adopt.set("judged", unit);
        judged_.texture().bind(unit);
        draw(adopting, result_.target(), unit + 1, look);
    });
    return result_.texture();
}

const Texture& MultiViewRefinement::better(const ComparedView& view, std::span<const ComparedView> all) {
    return better(look_at(view, all, max_others));
}

const Texture& MultiViewRefinement::refine_foreground(const ComparedView& view,
                                               std::span<const ComparedView> all,
                                               const Texture& tiles) {
    return move_and_carve(look_at(view, all, max_others, &tiles));
}

const Texture& MultiViewRefinement::refine_background(const ComparedView& view,
                                        std::span<const ComparedView> all) {
    const Look look = look_at(view, all, max_others);
    const Texture& refined = better(look);
    if (look->others.empty() || !shows_floor(all)) return refined;
    with_floor_.resize(refined.size());
    then([=, this, &refined] {
        TilePass& standing = floor_[look->others.size() - 1];
        Program& program = standing.use();
        const int unit = bind_others(program, *look->view.depth_m, look);
        // Of the points where z times the ray from the camera is at y = 0.
        const Pose& pose = look->view.camera().world_from_camera;
        const Eigen::RowVector3d inverse_z =
            pose.linear().row(1) * look->view.K_depth().inverse() / -pose.translation().y();
        program.set("floor_plane", Eigen::Vector3f(inverse_z.transpose().cast<float>()));
        program.set("softness", agreeing_softness);
        program.set("before", unit);
        refined.bind(unit);
        draw(standing, with_floor_.target(), unit + 1, look);
    });
    return with_floor_.texture();
}

}  // namespace vantage
