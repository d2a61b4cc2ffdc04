#include "host_app/fused/staged_preparer.h"

#include <algorithm>

#include <fmt/format.h>

#include "common/base/log.h"
#include "host_app/views/depth_spread.h"
#include "host_app/views/view_ranking.h"

namespace vantage {
namespace {

/// Between two models of a set at the best level, and between two works of improve().
constexpr double model_period_s = 0.5, improvement_period_s = 0.8;
/// Before improve() makes a rig's best model anew: first, then twice as long each time, for what
/// stands still is soon known as well as it will be. What has changed since a model is not of it.
constexpr double first_model_rest_s = 1, longest_model_rest_s = 12;
/// Before the sets are matched, from when they are learnt; and between two matches: first, then
/// twice as long each time, for what is found in a set that stands still hardly changes.
constexpr double learnt_before_match_s = 2.5, first_match_rest_s = 5, longest_match_rest_s = 80;
/// For so long the cheapest levels keep the shape of a known set, colours change every instant.
constexpr double shape_kept_s = 1;
/// Instants, before which there is nothing to remember.
constexpr int remembered_from = 3;
/// Between two looks at how much of the sets is known, and at the mattes.
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
      colour_performers_(library, "foreground_colour.frag") {
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
    // So many that there is something to remember, and time to better the set.
    match_anew(std::numeric_limits<double>::infinity());
    for (int i = 0; i < remembered_from; ++i) take(views, improvement_period_s);
    constexpr PrepareLevel best_of_one{0, 1, true, true};
    (void)prepare(target, prepare_levels().back());
    (void)prepare(target, best_of_one);
    // A set that is matched is bettered in another way.
    for (RigHistory* rig : uploaded_) {
        const DepthImage none(rig->depth().size(), 0.0f);
        rig->set_background_match(none, none, ColourImage(none.size()));
    }
    improve(target);
    level_ = prepare_levels().front();
    rigs_.forget();
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
        // Performers are carved by all that have learnt.
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
        misfit = fmt::format("the set that was loaded has none of rig {}: it is learnt anew", name);
    else if (found->calibration !=
             calibration_of(rig.camera(), rig.fresh_colour().size(), rig.depth().size()))
        misfit = fmt::format(
            "the set that was loaded was learnt with another calibration or picture size of rig "
            "{}: it is learnt anew",
            name);
    else
        BackgroundModel::restore(rig, *found);
    if (!misfit.empty() && misfits_[name] != misfit) log_warning("{}", misfit);
    misfits_[name] = misfit;
}

void StagedPreparer::look_at_sets() {
    looked_s_ = now_s_;
    states_.clear();
    for (const RigHistory* rig : uploaded_) {
        const auto misfit = misfits_.find(rig->camera().name);
        const BackgroundModel::Look look =
            rig->learnt_instants() > 0 ? sets_.look_at(*rig) : BackgroundModel::Look();
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
            show.set("learnt", 0);
            show.set("picture", 1);
            show.set("learnt_then", 2);
            show.set("picture_then", 3);
            show.set("matched", 4);
            show.set("spread", depth_spread(one->camera()));
            one->steady_depth().bind(0);
            one->colour().bind(1);
            one->match()->learnt_m.bind(2);
            one->match()->colour.bind(3);
            one->match()->depth_m.bind(4);
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
        if (!rig->model()) continue;
        // As soon as there is time.
        RigHistory::Model model = *rig->model();
        model.rest_s = 0;
        rig->set_background_model(model);
    }
}

void StagedPreparer::match_anew(double due_s) {
    matched_.reset();
    match_due_s_ = due_s;
    match_rest_s_ = first_match_rest_s;
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
                           .made = rig.learnt_instants()};
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
    program.set("picture", 0);
    program.set("background_colour", 1);
    program.set("matte", 2);
    rig.fresh_colour().bind(0);
    rig.colour().bind(1);
    rig.matte().texture().bind(2);
    colour_performers_.draw(surface->colour_target(), rig.matte_tiles().texture(), 3,
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
    BackgroundModel::bind_now(show, rig, rig.background_state().state(), 0);
    show.set("depth_map", 2);
    show.set("seen", 3);
    show.set("performers", 4);
    show.set("colour", 5);
    show.set("colour_mean", 6);
    show.set("known_after", BackgroundModel::known_after(rig));
    rig.depth().bind(2);
    rig.background_state().seen().bind(3);
    performers_m.bind(4);
    rig.colour().bind(5);
    rig.colour_mean().bind(6);
    show_.draw(surface.depth_target());
    edge_confidence_.judge(surface);
    triangles_.build(surface.grid(QuadGrid::coarse), level.bend);
    if (level.has_fine_grid) {
        triangles_.build(surface.grid(QuadGrid::fine));
        triangles_.build_rims(surface);
    }
    surface.set_has_fine_grid(level.has_fine_grid);
    // What is not known yet comes to light instant by instant.
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
    now.set("picture", 0);
    now.set("background_colour", 1);
    now.set("performers", 2);
    now.set("seen", 3);
    now.set("matte", 4);
    now.set("background_depth", 5);
    now.set("confidence", 6);
    now.set("remembered", RigSurface::remembered_confidence);
    rig.fresh_colour().bind(0);
    rig.colour().bind(1);
    performers_m.bind(2);
    rig.background_state().seen().bind(3);
    rig.matte().texture().bind(4);
    surface->depth().bind(5);
    surface->confidence().texture().bind(6);
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
    return instant;
}

void StagedPreparer::improve(const VirtualView& target) {
    while (improve_a_step(target, BackgroundStereoTask::Manner::when_waited_for)) continue;
    if (const auto depths_m = matching_.take(true)) take_match(*depths_m);
}

bool StagedPreparer::improve_a_step(const VirtualView& target, BackgroundStereoTask::Manner manner) {
    if (match_a_step(manner)) return true;
    if (refinement_pass_ && !is_under_way(*refinement_pass_)) refinement_pass_.reset();
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
    if (now_s_ - improved_s_ < improvement_period_s) return;
    // Of those that are looked at the one whose model is due for longest.
    const auto due_s = [](const RigHistory& rig) {
        return rig.model()->made_s + (rig.model()->rank == 0 ? rig.model()->rest_s : 0);
    };
    RigHistory* oldest = nullptr;
    for (RigHistory* rig : most_useful(rigs_.shown(), target, most_drawn_rigs))
        if (rig->model() && due_s(*rig) <= now_s_ && (!oldest || due_s(*rig) < due_s(*oldest)))
            oldest = rig;
    if (!oldest) return;
    learn(uploaded_);
    refinement_pass_.emplace();
    for (RigHistory* rig : rigs_.shown())
        if (rig->learnt_instants() > 0)
            refinement_pass_->rigs.push_back(
                {rig, rig->colour().size(), rig->depth().size(), rig->match().has_value()});
    refinement_pass_->steps = model_in_steps(*oldest, prepare_levels().front());
}

bool StagedPreparer::is_under_way(const Refining& refining) const {
    return std::all_of(
        refining.rigs.begin(), refining.rigs.end(), [&](const Refining::Rig& rig) {
            return rigs_.has_learnt(rig.rig) && rig.rig->colour().size() == rig.colour &&
                   rig.rig->depth().size() == rig.depth &&
                   rig.rig->match().has_value() == rig.is_matched;
        });
}

}  // namespace vantage
