#include "host_app/fused/staged_preparer.h"

#include <algorithm>

#include <fmt/format.h>

#include "common/base/log.h"
#include "host_app/baked/baked_painter.h"
#include "host_app/fused/fused_renderer.h"
#include "host_app/views/depth_view.h"
#include "host_app/views/view_ranking.h"

namespace vantage {
namespace {

/// Least time between two background models of a rig at the best level, and between two
/// refinements.
constexpr double model_period_s = 0.5, improvement_period_s = 0.8;
/// Time before a rig's best model is refined again: the first time, and doubled each time up to the
/// longest, since a background that stands still is soon known as well as it can be.
constexpr double first_model_rest_s = 1, longest_model_rest_s = 12;
/// Time from the first learning to background stereo, and between two runs of it: the first time,
/// and doubled each time up to the longest, since results for a still background hardly change.
constexpr double learnt_before_match_s = 2.5, first_match_rest_s = 5, longest_match_rest_s = 80;
/// Least time before a probe of the baked background is made anew.
constexpr double probe_rest_s = 8;
/// Instants that a background must be learnt from before it is baked: earlier it may still hold
/// performers.
constexpr int baked_from = 8;
/// Share of a rig's picture whose background has changed, from which on its model is made anew at
/// once; until then the background is not drawn from its probes, which lack the change.
constexpr double changed_share_to_model = 0.01;
/// Time for which the cheapest levels keep a known background's shape; colours are always new.
constexpr double shape_kept_s = 1;
/// Instants that must be learnt before hidden parts of the background are remembered.
constexpr int remembered_from = 3;
/// Time between two status updates of the backgrounds and the mattes.
constexpr double look_period_s = 1;

}  // namespace

StagedPreparer::StagedPreparer(const ShaderLibrary& library)
    : sets_(library),
      performers_(library),
      refinement_(library),
      inpainting_(library),
      edge_confidence_(library),
      triangles_(library),
      show_(library, "background_show.frag"),
      now_(library, "colours_now.frag"),
      show_matched_(library, "background_matched.frag"),
      colour_performers_(library, "foreground_colour.frag"),
      learnt_colours_(library, "learnt_colours.frag"),
      copy_(library, "copy.frag"),
      probe_renderer_(make_fused_renderer(library)) {
    match_anew(learnt_before_match_s);
}

void StagedPreparer::take(std::span<const DepthView> views, double dt_s) {
    now_s_ += dt_s;
    uploaded_ = rigs_.upload(views, dt_s);
    for (RigHistory* rig : uploaded_) begin_with_learnt(*rig);
    learnt_.clear();
    has_depths_.clear();
    if (std::exchange(is_after_cut_, false)) return;
    learn(level_.is_refined ? uploaded_ : rigs_in_turn());
    if (now_s_ - looked_s_ >= look_period_s || states_.size() != uploaded_.size()) look_at_sets();
}

void StagedPreparer::warm_up(std::span<const DepthView> views, const VirtualView& target) {
    // Enough instants to remember a background, with enough time between them to refine it.
    match_anew(std::numeric_limits<double>::infinity());
    for (int i = 0; i < remembered_from; ++i) take(views, improvement_period_s);
    constexpr PrepareLevel best_of_one{0, 1, true, true};
    (void)prepare(target, prepare_levels().back());
    (void)prepare(target, best_of_one);
    // Refinement of a matched background uses other shaders.
    for (RigHistory* rig : uploaded_) {
        const DepthImage none(rig->depth().size(), 0.0f);
        rig->set_background_match(none, none, ColourImage(none.size()));
    }
    improve(target);
    level_ = prepare_levels().front();
    rigs_.forget();
    probes_.clear();
    probe_cameras_.clear();
    modelled_.clear();
    rendered_ = nullptr;
    baked_.reset();
    improved_s_ = now_s_;
    match_anew(now_s_ + learnt_before_match_s);
}

void StagedPreparer::cut() {
    rigs_.cut();
    is_after_cut_ = true;
}

void StagedPreparer::learn(std::span<RigHistory* const> rigs) {
    for (RigHistory* rig : rigs) {
        const auto holds = [rig](const std::vector<RigHistory*>& some) {
            return std::find(some.begin(), some.end(), rig) != some.end();
        };
        if (holds(learnt_) || !holds(uploaded_)) continue;
        sets_.learn(*rig);
        learnt_.push_back(rig);
        // The foreground's depth depends on all rigs whose background is learnt.
        has_depths_.clear();
    }
}

std::vector<RigHistory*> StagedPreparer::rigs_in_turn() const {
    std::vector<RigHistory*> rigs;
    RigHistory* longest_left = nullptr;
    for (RigHistory* rig : uploaded_)
        if (prepared_rigs_.contains(rig))
            rigs.push_back(rig);
        else if (!longest_left || rig->dt_s() > longest_left->dt_s())
            longest_left = rig;
    if (longest_left) rigs.push_back(longest_left);
    return rigs;
}

void StagedPreparer::begin_with_learnt(RigHistory& rig) {
    if (!begins_with_ || rig.learnt_instants() > 0) return;
    const std::string& name = rig.camera().name;
    const auto found = std::find_if(begins_with_->rigs.begin(), begins_with_->rigs.end(),
                                    [&](const RigBackground& set) { return set.rig == name; });
    std::string misfit;
    if (found == begins_with_->rigs.end())
        misfit = fmt::format(
            "the loaded background has no rig {}: that rig's background is learnt anew", name);
    else if (found->calibration !=
             calibration_of(rig.camera(), rig.fresh_colour().size(), rig.depth().size()))
        misfit = fmt::format(
            "the loaded background was learnt with another calibration or image size of rig {}: "
            "that "
            "rig's background is learnt anew",
            name);
    else
        BackgroundModel::restore(rig, *found);
    if (!misfit.empty() && misfits_[name] != misfit) log_warning("{}", misfit);
    misfits_[name] = misfit;
}

void StagedPreparer::look_at_sets() {
    looked_s_ = now_s_;
    states_.clear();
    is_background_still_ = true;
    for (RigHistory* rig : uploaded_) {
        const auto misfit = misfits_.find(rig->camera().name);
        const BackgroundModel::Look look =
            rig->learnt_instants() > 0 ? sets_.look_at(*rig) : BackgroundModel::Look();
        if (look.changed_share > changed_share_to_model) {
            is_background_still_ = false;
            make_model_due(*rig);
        }
        states_.push_back({.rig = rig->camera().name,
                           .known = look.known_share,
                           .is_loaded = misfit != misfits_.end() && misfit->second.empty(),
                           .misfit = misfit != misfits_.end() ? misfit->second : "",
                           .matte = look.matte});
    }
}

void StagedPreparer::begin_with(std::shared_ptr<const Background> set) {
    begins_with_ = std::move(set);
    misfits_.clear();
    states_.clear();
    match_anew(now_s_ + learnt_before_match_s);
}

void StagedPreparer::learn_anew() {
    begin_with(nullptr);
    rigs_.forget();
}

Background StagedPreparer::learnt() const {
    Background set;
    set.learnt = TaiClock::now();
    for (const RigHistory* rig : rigs_.known())
        if (rig->learnt_instants() > 0) set.rigs.push_back(BackgroundModel::learnt(*rig));
    return set;
}

const Texture& StagedPreparer::refined_background(RigHistory& rig) {
    ComparedView view = compared(rig);
    std::vector<ComparedView> all;
    for (RigHistory* one : rigs_.shown()) {
        all.push_back(compared(*one));
        if (!one->match() || one->learnt_instants() == 0) continue;
        one->matched_depth().resize(one->depth().size());
        all.back().depth_m = &one->matched_depth().texture();
        all.back().is_matched = true;
        if (one == &rig) view = all.back();
        refinement_.then([this, one] {
            Program& show = show_matched_.use();
            show.input("learnt", one->steady_depth());
            show.input("picture", one->colour());
            show.input("learnt_then", one->match()->learnt_m);
            show.input("picture_then", one->match()->colour);
            show.input("matched", one->match()->depth_m);
            show.set("spread", depth_spread(one->camera()));
            show_matched_.draw(one->matched_depth().target());
        });
    }
    return refinement_.refine_background(view, all);
}

bool StagedPreparer::match_a_step(BackgroundStereoTask::Manner manner) {
    if (matching_.is_under_way()) {
        if (const auto depths_m = matching_.take()) take_match(*depths_m);
        return false;
    }
    if (!matched_) {
        if (now_s_ < match_due_s_) return false;
        Matched next;
        for (RigHistory* rig : rigs_.shown())
            if (rig->learnt_instants() > 0) next.rigs.push_back(rig);
        if (next.rigs.size() < 2) return false;
        matched_ = std::move(next);
    }
    const RigHistory* rig = matched_->rigs[matched_->sets.size()];
    if (!rigs_.has_learnt(rig)) {
        matched_.reset();
        return false;
    }
    matched_->sets.push_back(BackgroundModel::picture(*rig));
    matched_->depth_sizes.push_back(rig->depth().size());
    if (matched_->sets.size() < matched_->rigs.size()) return true;
    matching_.begin(matched_->sets, manner);
    return false;
}

void StagedPreparer::take_match(std::span<const DepthImage> depths_m) {
    const std::optional<Matched> matched = std::exchange(matched_, std::nullopt);
    if (!matched) return;
    match_due_s_ = now_s_ + match_rest_s_;
    match_rest_s_ = std::min(2 * match_rest_s_, longest_match_rest_s);
    for (std::size_t i = 0; i < depths_m.size(); ++i) {
        RigHistory* rig = matched->rigs[i];
        if (!rigs_.has_learnt(rig) || rig->depth().size() != matched->depth_sizes[i]) continue;
        if (cv::countNonZero(depths_m[i]) == 0) continue;  // no other rig stands far enough from it
        rig->set_background_match(depths_m[i], matched->sets[i].depth_m, matched->sets[i].colour);
        make_model_due(*rig);
    }
}

void StagedPreparer::make_model_due(RigHistory& rig) {
    if (!rig.model() || rig.model()->rest_s == 0) return;
    RigHistory::Model model = *rig.model();
    model.rest_s = 0;
    rig.set_background_model(model);
}

void StagedPreparer::match_anew(double due_s) {
    matched_.reset();
    match_due_s_ = due_s;
    match_rest_s_ = first_match_rest_s;
}

std::shared_ptr<const DrawnTexture> StagedPreparer::copy_of(const Texture& texture,
                                                            TextureFormat format) {
    auto copy = std::make_shared<DrawnTexture>(format);
    copy->resize(texture.size());
    copy_.use().input("source", texture);
    copy_.draw(copy->target());
    return copy;
}

std::deque<MultiViewRefinement::Step> StagedPreparer::model_in_steps(RigHistory& rig,
                                                                     const PrepareLevel& level) {
    rig.generate_mipmaps();
    const Texture* depth_m = &rig.steady_depth();
    const Texture* measured_m = depth_m;
    std::deque<MultiViewRefinement::Step> steps;
    if (level.is_refined) steps = refinement_.in_steps([&] { depth_m = &refined_background(rig); });
    const std::optional<RigHistory::Model>& before = rig.model();
    RigHistory::Model made{.surface = nullptr,
                           .rank = level.rank,
                           .rest_s = first_model_rest_s,
                           .made_s = now_s_,
                           .made = rig.learnt_instants(),
                           .learnt_m = copy_of(*depth_m, TextureFormat::r32f),
                           .colour = copy_of(rig.colour(), TextureFormat::rgba8)};
    if (before && before->rank == 0)
        made.rest_s = std::clamp(2 * before->rest_s, first_model_rest_s, longest_model_rest_s);
    steps.push_back([=, this, &rig, &colour = rig.colour()]() mutable {
        const std::shared_ptr<RigSurface> model = surfaces_.take(shapes_);
        model->begin(rig.camera(), rig.colour().size(), rig.depth().size(), rig.samples());
        inpainting_.close(*depth_m, *measured_m, colour, model->depth_target());
        made.surface = model;
        rig.set_background_model(made);
    });
    return steps;
}

void StagedPreparer::make_model(RigHistory& rig, const PrepareLevel& level) {
    refinement_pass_.reset();
    for (const MultiViewRefinement::Step& step : model_in_steps(rig, level)) step();
}

std::shared_ptr<const RigSurface> StagedPreparer::performers_of(RigHistory& rig,
                                                                const PrepareLevel& level) {
    const std::shared_ptr<RigSurface> surface = surfaces_.take(shapes_);
    surface->begin(rig.camera(), rig.colour().size(), rig.depth().size(), rig.samples());
    if (level.is_refined) {
        for (RigHistory* one : uploaded_) {
            if (has_depths_.contains(one)) continue;
            one->foreground_depth().resize(one->depth().size());
            performers_.find(*one, learnt_, one->foreground_depth().target());
            has_depths_.insert(one);
        }
        performers_.better(rig, uploaded_, surface->depth_target());
    } else {
        performers_.find(rig, learnt_, surface->depth_target());
    }
    Program& program = colour_performers_.use();
    program.input("picture", rig.fresh_colour());
    program.input("background_colour", rig.colour());
    program.input("matte", rig.matte().texture());
    colour_performers_.draw(surface->colour_target(), rig.matte_tiles().texture(),
                            rig.fresh_colour().size());
    triangles_.build_where(surface->grid(QuadGrid::coarse), rig.matte_tiles().texture(),
                           rig.fresh_colour().size(), level.bend);
    return surface;
}

bool StagedPreparer::has_shape(const RigHistory& rig, const PrepareLevel& level) const {
    return !level.is_refined && rig.shape_made_s() && now_s_ - *rig.shape_made_s() < shape_kept_s &&
           (rig.surface()->has_fine_grid() || !level.has_fine_grid);
}

void StagedPreparer::make_shape(RigSurface& surface, RigHistory& rig, const Texture& performers_m,
                                const PrepareLevel& level) {
    Program& show = show_.use();
    BackgroundModel::set_background_now(show, rig, rig.background_state().state());
    show.input("depth_map", rig.depth());
    show.input("seen", rig.background_state().seen());
    show.input("performers", performers_m);
    show.input("colour", rig.colour());
    show.input("colour_mean", rig.colour_mean());
    show.set("known_after", BackgroundModel::known_after(rig));
    show_.draw(surface.depth_target());
    edge_confidence_.judge(surface);
    triangles_.build(surface.grid(QuadGrid::coarse), level.bend);
    if (level.has_fine_grid) {
        triangles_.build(surface.grid(QuadGrid::fine));
        triangles_.build_rims(surface);
    }
    surface.set_has_fine_grid(level.has_fine_grid);
    // A background that is not known yet grows with every instant.
    const bool is_kept = !level.is_refined && rig.model()->rank == 0;
    rig.set_shape_made_s(is_kept ? std::optional(now_s_) : std::nullopt);
}

std::shared_ptr<const RigSurface> StagedPreparer::set_of(RigHistory& rig,
                                                         const Texture& performers_m,
                                                         const PrepareLevel& level) {
    const std::shared_ptr<RigSurface> surface = surfaces_.take(shapes_);
    if (has_shape(rig, level)) {
        surface->begin_like(*rig.surface(), rig.samples());
    } else {
        surface->begin(rig.camera(), rig.colour().size(), rig.depth().size(), rig.samples());
        make_shape(*surface, rig, performers_m, level);
    }
    Program& now = now_.use();
    now.input("picture", rig.fresh_colour());
    now.input("background_colour", rig.colour());
    now.input("performers", performers_m);
    now.input("seen", rig.background_state().seen());
    now.input("matte", rig.matte().texture());
    now.input("background_depth", surface->depth());
    now.input("confidence", surface->confidence().texture());
    now.set("remembered", RigSurface::remembered_confidence);
    now_.draw(surface->colour_target());
    surface->finish_colour();
    return surface;
}

void StagedPreparer::publish(RigHistory& rig, const PrepareLevel& level) {
    const bool is_best = level.rank == 0;
    if (!rig.model() ||
        (is_best && (rig.model()->rank > 0 || now_s_ - rig.model()->made_s >= model_period_s)))
        make_model(rig, level);
    const std::shared_ptr<const RigSurface> performers = performers_of(rig, level);
    rig.publish(set_of(rig, performers->depth(), level), performers, level.rank);
}

std::shared_ptr<const Instant> StagedPreparer::prepare(const VirtualView& target,
                                                       const PrepareLevel& level) {
    auto instant = std::make_shared<Instant>();
    instant->level = level.rank;
    const std::vector<RigHistory*> rigs = most_useful(rigs_.shown(), target, level.rigs);
    level_ = level;
    prepared_rigs_ = {rigs.begin(), rigs.end()};
    learn(level.is_refined ? uploaded_ : rigs);
    for (RigHistory* rig : rigs) {
        if (!rig->prepared_rank() || *rig->prepared_rank() > level.rank) publish(*rig, level);
        instant->rigs.push_back({rig->surface(), rig->performers(), rig->presence()});
    }
    if (is_background_still_ && are_probes_made(target)) instant->extra = baked_;
    return instant;
}

std::shared_ptr<const RigSurface> StagedPreparer::model_surface(RigHistory& rig) {
    ModelSurface& kept = modelled_[rig.camera().name];
    if (kept.model == rig.model()->surface) return kept.surface;
    const std::shared_ptr<RigSurface> surface = surfaces_.take(shapes_);
    surface->begin_like(*rig.model()->surface, rig.samples());
    edge_confidence_.judge(*surface);
    triangles_.build(surface->grid(QuadGrid::coarse));
    triangles_.build(surface->grid(QuadGrid::fine));
    triangles_.build_rims(*surface);
    surface->set_has_fine_grid(true);
    Program& program = learnt_colours_.use();
    program.input("background_colour", rig.colour());
    program.input("confidence", surface->confidence().texture());
    learnt_colours_.draw(surface->colour_target());
    surface->finish_colour();
    kept = {rig.model()->surface, surface};
    return surface;
}

void StagedPreparer::place_probes(std::span<RigHistory* const> rigs) {
    std::vector<DepthView> cameras;
    std::vector<const DepthView*> pointers;
    for (const RigHistory* rig : rigs) {
        cameras.push_back(rig->camera());
        cameras.back().colour = ColourImage(rig->fresh_colour().size());
    }
    const auto same = [](const DepthView& a, const DepthView& b) {
        return a.name == b.name && a.K == b.K && a.colour.size() == b.colour.size() &&
               a.world_from_camera.matrix() == b.world_from_camera.matrix();
    };
    if (std::equal(cameras.begin(), cameras.end(), probe_cameras_.begin(), probe_cameras_.end(),
                   same))
        return;
    for (const DepthView& camera : cameras) pointers.push_back(&camera);
    probes_.clear();
    modelled_.clear();
    rendered_ = nullptr;
    for (const VirtualView& view : probe_views(pointers)) probes_.push_back({view, nullptr});
    parallax_px_m_ = largest_parallax_px_m(probe_views(pointers));
    probe_cameras_ = std::move(cameras);
}

std::vector<StagedPreparer::Probe*> StagedPreparer::nearest_first(const VirtualView& target) {
    std::vector<Probe*> nearest;
    for (Probe& probe : probes_) nearest.push_back(&probe);
    const auto away_m = [&](const Probe* probe) {
        return (probe->view.world_from_camera.translation() -
                target.world_from_camera.translation())
            .norm();
    };
    std::sort(nearest.begin(), nearest.end(),
              [&](const Probe* a, const Probe* b) { return away_m(a) < away_m(b); });
    return nearest;
}

bool StagedPreparer::are_probes_made(const VirtualView& target) {
    const std::vector<Probe*> nearest = nearest_first(target);
    const std::size_t needed = std::min(nearest.size(), BakedPainter::most_probes);
    return needed > 0 && std::all_of(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(needed),
                                     [](const Probe* probe) { return probe->made != nullptr; });
}

bool StagedPreparer::bake_a_step(const VirtualView& target) {
    std::vector<RigHistory*> rigs;
    double changed_s = -1;
    for (RigHistory* rig : rigs_.shown()) {
        if (!rig->model() || rig->model()->made < baked_from) return false;
        changed_s = std::max(changed_s, rig->model()->made_s);
        rigs.push_back(rig);
    }
    if (rigs.empty()) return false;
    // Views come in any order.
    std::sort(rigs.begin(), rigs.end(), [](const RigHistory* a, const RigHistory* b) {
        return a->camera().name < b->camera().name;
    });
    place_probes(rigs);
    if (Probe* probe = std::exchange(rendered_, nullptr)) {
        const cv::Mat depth_m = cv::abs(probe_renderer_->depth_m()->download());
        probe->made = std::make_shared<const BackgroundProbe>(
            probe->view, ColourImage(probe_picture_->download()), DepthImage(depth_m),
            parallax_px_m_);
        auto background = std::make_shared<BakedBackground>();
        for (const Probe& one : probes_)
            if (one.made) background->probes.push_back(one.made);
        auto extra = std::make_shared<BakedExtra>();
        extra->background = std::move(background);
        baked_ = std::move(extra);
    }
    Probe* next = nullptr;
    for (Probe* probe : nearest_first(target)) {
        const bool is_due = probe->made_s < 0 || (probe->made_s < changed_s &&
                                                  now_s_ - probe->made_s > probe_rest_s);
        if (!next && is_due) next = probe;
    }
    if (!next) return false;
    Instant background;
    for (RigHistory* rig : rigs) background.rigs.push_back({model_surface(*rig)});
    probe_picture_ = &probe_renderer_->render(background, next->view, render_levels().front());
    glFlush();
    next->made_s = now_s_;
    rendered_ = next;
    return true;
}

void StagedPreparer::improve(const VirtualView& target) {
    while (improve_a_step(target, BackgroundStereoTask::Manner::when_waited_for)) continue;
    if (const auto depths_m = matching_.take(true)) take_match(*depths_m);
}

bool StagedPreparer::improve_a_step(const VirtualView& target,
                                    BackgroundStereoTask::Manner manner) {
    if (match_a_step(manner)) return true;
    if (refinement_pass_ && !is_under_way(*refinement_pass_)) refinement_pass_.reset();
    if (!refinement_pass_ && bake_a_step(target)) return true;
    if (!refinement_pass_) begin_refining(target);
    if (!refinement_pass_) return false;
    const MultiViewRefinement::Step step = std::move(refinement_pass_->steps.front());
    refinement_pass_->steps.pop_front();
    if (refinement_pass_->steps.empty()) {
        refinement_pass_.reset();
        improved_s_ = now_s_;
    }
    step();
    return refinement_pass_.has_value();
}

void StagedPreparer::begin_refining(const VirtualView& target) {
    // The rig whose model has been due for longest; one without a model is due at once.
    const auto due_s = [](const RigHistory& rig) {
        if (!rig.model()) return -1.0;
        return rig.model()->made_s + (rig.model()->rank == 0 ? rig.model()->rest_s : 0);
    };
    RigHistory* oldest = nullptr;
    const auto look_at = [&](RigHistory* rig) {
        if (due_s(*rig) <= now_s_ && (!oldest || due_s(*rig) < due_s(*oldest))) oldest = rig;
    };
    for (RigHistory* rig : most_useful(rigs_.shown(), target, most_drawn_rigs)) look_at(rig);
    for (RigHistory* rig : rigs_.shown()) look_at(rig);
    if (!oldest || (oldest->model() && now_s_ - improved_s_ < improvement_period_s)) return;
    learn(uploaded_);
    refinement_pass_.emplace();
    for (RigHistory* rig : rigs_.shown())
        if (rig->learnt_instants() > 0)
            refinement_pass_->rigs.push_back(
                {rig, rig->colour().size(), rig->depth().size(), rig->match().has_value()});
    refinement_pass_->steps = model_in_steps(*oldest, prepare_levels().front());
}

bool StagedPreparer::is_under_way(const Refining& refining) const {
    return std::all_of(refining.rigs.begin(), refining.rigs.end(), [&](const Refining::Rig& rig) {
        return rigs_.has_learnt(rig.rig) && rig.rig->colour().size() == rig.colour &&
               rig.rig->depth().size() == rig.depth &&
               rig.rig->match().has_value() == rig.is_matched;
    });
}

}  // namespace vantage
