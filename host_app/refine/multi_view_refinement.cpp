#include "host_app/refine/multi_view_refinement.h"

#include <cmath>

#include <Eigen/LU>

#include "host_app/views/depth_view.h"
#include "host_app/views/projection.h"
#include "host_app/views/view_ranking.h"

namespace vantage {
namespace {

/// Parallax of the other rigs, in parallaxes of the rig's own two cameras, from which on they
/// measure depth better than it does itself.
constexpr double min_parallax_ratio = 2;
/// Steps of the two plane sweeps: parallax in px of the depth map.
constexpr double coarse_step_px = 2, fine_step_px = 1;
/// Parallax errors up to the first are invisible; moves up to the second would only lose detail.
constexpr double exact_px = 0.7, min_change_px = 0.5;
/// Share of the surface points that must lie on the floor for the rigs to see one.
constexpr double floor_share = 0.05;
/// Relative uncertainty of exact depth, which does not come from stereo.
constexpr double min_sigma = 0.002;

/// The view's camera, for a depth map of this size.
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
            const double sigma_m = std::abs(away_m.y()) * std::max(z_m * spread, min_sigma);
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
        consistency_pass_.emplace_back(library, "rig_consistency.frag", ShaderDefines{count});
        carve_.emplace_back(library, "rig_carve.frag", ShaderDefines{count, {"MOVES", "0"}});
        move_and_carve_.emplace_back(library, "rig_carve.frag",
                                     ShaderDefines{count, {"MOVES", "1"}});
        adopt_.emplace_back(library, "rig_adopt.frag", ShaderDefines{count});
        floor_.emplace_back(library, "rig_floor.frag", ShaderDefines{count});
    }
    whole_.upload(cv::Mat1b(1, 1, uchar{255}));
}

std::deque<MultiViewRefinement::Step> MultiViewRefinement::in_steps(
    const std::function<void()>& work) {
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

void MultiViewRefinement::draw(TilePass& pass, const Framebuffer& target, const Group& group) {
    pass.draw(target, *group->tiles, group->picture);
}

void MultiViewRefinement::set_view(Program& program, const Texture& depth_m,
                                   const ComparedView& view) {
    program.input("depth_map", depth_m);
    program.input("picture", *view.colour);
}

void MultiViewRefinement::set_others(Program& program, const Texture& depth_m, const Group& group) {
    const ComparedView& view = group->view;
    set_view(program, depth_m, view);
    const VirtualView camera = depth_camera(view, depth_m.size());
    program.set("spread", depth_spread(view.camera()));
    for (std::size_t i = 0; i < group->others.size(); ++i) {
        const ComparedView& other = group->others[i];
        program.input("other_depth", i, *other.depth_m);
        program.input("other_colour", i, *other.colour);
        program.set("other_from_pixel", i,
                    Eigen::Matrix4f(pixel_from_target_pixel(other.camera(), camera).cast<float>()));
        program.set("other_size", i,
                    Eigen::Vector2f(static_cast<float>(other.colour->width_px()),
                                    static_cast<float>(other.colour->height_px())));
        program.set("other_spread", i, depth_spread(other.camera()));
    }
}

double MultiViewRefinement::parallax_px(const Group& group) {
    const ComparedView& view = group->view;
    const VirtualView camera = depth_camera(view, view.depth_m->size());
    const Eigen::Vector2d middle_px(0.5 * camera.width_px, 0.5 * camera.height_px);
    double largest = 0;
    for (const ComparedView& other : group->others)
        largest =
            std::max(largest, vantage::parallax_px(pixel_from_target_pixel(other.camera(), camera),
                                                   middle_px, view.median_depth_m()));
    return largest;
}

bool MultiViewRefinement::has_wide_baseline(const ComparedView& view, double parallax_px) {
    const double own_px = own_parallax_px(view);
    return own_px > 0 && parallax_px > min_parallax_ratio * own_px;
}

void MultiViewRefinement::smooth(TilePass& pass, const Texture& depth_m, const Group& group,
                                 const Framebuffer& target) {
    set_view(pass.use(), depth_m, group->view);
    draw(pass, target, group);
}

void MultiViewRefinement::sweep_once(const Group& group, double relative_step) {
    const ComparedView& view = group->view;
    const cv::Size size = half_.texture().size();
    // Before the inputs, since making a texture binds it.
    const Framebuffer& refined = half_.next_target(size);
    TilePass& comparing = sweep_[group->others.size() - 1];
    Program& compare = comparing.use();
    set_others(compare, half_.texture(), group);
    compare.set("relative_step", static_cast<float>(relative_step));
    compare.set("lod", std::log2(static_cast<float>(view.colour->width_px()) /
                                 static_cast<float>(size.width)));
    draw(comparing, costs_->target, group);

    Program& refine = refine_.use();
    set_view(refine, half_.texture(), view);
    refine.set("relative_step", static_cast<float>(relative_step));
    for (std::size_t i = 0; i < costs_->cost.size(); ++i) refine.input("costs", i, costs_->cost[i]);
    draw(refine_, refined, group);
    half_.finish();
}

void MultiViewRefinement::sweep(const Group& group, double parallax_px) {
    const cv::Size size = group->view.depth_m->size(),
                   half((size.width + 1) / 2, (size.height + 1) / 2);
    then([=, this] {
        half_before_.resize(half);
        if (!costs_ || costs_->cost[0].size() != half) costs_ = std::make_unique<Sweep>(half);
        smooth(halve_, *group->view.depth_m, group, half_before_.target());
        smooth(smooth_, half_before_.texture(), group, half_.next_target(half));
        half_.finish();
    });
    then([=, this] { sweep_once(group, coarse_step_px / parallax_px); });
    then([=, this] {
        smooth(smooth_, half_.texture(), group, half_.next_target(half));
        half_.finish();
        sweep_once(group, fine_step_px / parallax_px);
    });
}

void MultiViewRefinement::check_consistency(const Group& group, double parallax_px) {
    const Texture& depth_m = *group->view.depth_m;
    consistency_.resize({(depth_m.width_px() + 1) / 2, (depth_m.height_px() + 1) / 2});
    TilePass& comparing = consistency_pass_[group->others.size() - 1];
    Program& consistency = comparing.use();
    set_others(consistency, depth_m, group);
    consistency.set("exact", static_cast<float>(exact_px / std::max(parallax_px, 1.0)));
    draw(comparing, consistency_.target(), group);
    consistency_.generate_mipmaps();
}

MultiViewRefinement::Group MultiViewRefinement::group(const ComparedView& view,
                                                      std::span<const ComparedView> all,
                                                      const Texture* tiles) const {
    std::vector<const ComparedView*> others;
    for (const ComparedView& one : all)
        if (one.seen_by != view.seen_by) others.push_back(&one);
    auto group = std::make_shared<ViewGroup>();
    group->view = view;
    for (const ComparedView* other :
         most_useful(others, depth_camera(view, view.depth_m->size()), max_others))
        group->others.push_back(*other);
    group->tiles = tiles ? tiles : &whole_;
    group->picture = tiles ? view.colour->size() : cv::Size(TilePass::side_px, TilePass::side_px);
    return group;
}

const Texture& MultiViewRefinement::move_and_carve(const Group& group) {
    const Texture& depth_m = *group->view.depth_m;
    if (group->others.empty()) return depth_m;
    // Before the inputs, since making a texture binds it.
    result_.resize(depth_m.size());
    judged_.resize(depth_m.size());

    const double parallax = parallax_px(group);
    const bool is_single_rig = !group->view.is_matched,
               moves = has_wide_baseline(group->view, parallax);
    const Texture& carved = moves ? judged_.texture() : result_.texture();
    if (is_single_rig) then([=, this] { check_consistency(group, parallax); });
    if (is_single_rig && moves) sweep(group, parallax);
    then([=, this] {
        TilePass& carving = (moves ? move_and_carve_ : carve_)[group->others.size() - 1];
        Program& carve = carving.use();
        set_others(carve, *group->view.depth_m, group);
        carve.set("is_single_rig", is_single_rig);
        // A sampler that is not read needs an input too, which must not be the target.
        const auto input_if_read = [&](const char* name, const auto& drawn) {
            carve.input(name, is_single_rig ? drawn.texture() : *group->view.depth_m);
        };
        input_if_read("consistency", consistency_);
        if (moves) {
            input_if_read("half_before", half_before_);
            input_if_read("half_after", half_);
            carve.set("min_change", static_cast<float>(min_change_px / parallax));
        }
        draw(carving, moves ? judged_.target() : result_.target(), group);
    });
    return carved;
}

const Texture& MultiViewRefinement::refine(const Group& group) {
    const Texture& judged = move_and_carve(group);
    if (group->others.empty() || &judged == &result_.texture()) return judged;
    then([=, this] {
        TilePass& adopting = adopt_[group->others.size() - 1];
        Program& adopt = adopting.use();
        set_others(adopt, *group->view.depth_m, group);
        adopt.input("judged", judged_.texture());
        draw(adopting, result_.target(), group);
    });
    return result_.texture();
}

const Texture& MultiViewRefinement::refine(const ComparedView& view,
                                           std::span<const ComparedView> all) {
    return refine(group(view, all));
}

const Texture& MultiViewRefinement::refine_foreground(const ComparedView& view,
                                                      std::span<const ComparedView> all,
                                                      const Texture& tiles) {
    return move_and_carve(group(view, all, &tiles));
}

const Texture& MultiViewRefinement::refine_background(const ComparedView& view,
                                                      std::span<const ComparedView> all) {
    const Group group = this->group(view, all);
    const Texture& refined = refine(group);
    if (group->others.empty() || !shows_floor(all)) return refined;
    with_floor_.resize(refined.size());
    then([=, this, &refined] {
        TilePass& standing = floor_[group->others.size() - 1];
        Program& program = standing.use();
        set_others(program, *group->view.depth_m, group);
        // The inverse depth at which each pixel's ray from the camera meets y = 0.
        const Pose& pose = group->view.camera().world_from_camera;
        const Eigen::RowVector3d inverse_z =
            pose.linear().row(1) * group->view.K_depth().inverse() / -pose.translation().y();
        program.set("floor_plane", Eigen::Vector3f(inverse_z.transpose().cast<float>()));
        program.input("before", refined);
        draw(standing, with_floor_.target(), group);
    });
    return with_floor_.texture();
}

}  // namespace vantage
