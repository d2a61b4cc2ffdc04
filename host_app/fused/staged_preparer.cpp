#include "host_app/fused/staged_preparer.h"

#include <algorithm>

#include <fmt/format.h>

#include "common/base/log.h"
#include "host_app/fused/own_picture.h"
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
/// Time from the first learning to background stereo in half the size, from its end to the first
/// run in whole size, and between two of these: the first time, and doubled each time up to the
/// longest, since results for a still background hardly change.
constexpr double learnt_before_match_s = 1.5, whole_match_rest_s = 1, first_match_rest_s = 5,
                 longest_match_rest_s = 80;
/// Instants that a background must be learnt from before it is matched and baked: earlier it may
/// still hold performers.
constexpr int baked_from = 5;
/// Instants after which a rough model is made once more, if none was refined until then: it knows
/// places that performers have left meanwhile.
constexpr int rough_again_at = 10;
/// Share of a rig's picture whose background has changed, from which on its model is made anew, and
/// the share from which on it is patched at once and what was baked before is not drawn any more. A
/// place that a performer leaves for the first time is a small change.
constexpr double changed_share_to_renew = 0.001, changed_share_to_patch = 0.01;
/// Time between two status updates of the backgrounds and the mattes.
constexpr double look_period_s = 1;

/// The best level interpolates images bicubically.
float sharpening_of(const PrepareLevel& level) { return level.rank > 0 ? bilinear_sharpening : 0; }

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
      copy_(library, "copy.frag"),
      patch_(library, "background_patch.frag"),
      picture_now_(library, "picture_now.frag"),
      baker_(library) {
    match_anew(learnt_before_match_s);
}

void StagedPreparer::take(std::span<const DepthView> views, double dt_s) {
    now_s_ += dt_s;
    baker_.release_unused();
    uploaded_ = rigs_.upload(views, dt_s);
    for (RigHistory* rig : uploaded_) begin_with_learnt(*rig);
    learnt_.clear();
    has_depths_.clear();
    if (std::exchange(is_after_cut_, false)) return;
    // Nothing is baked before every rig's background is known.
    const bool are_known =
        std::all_of(uploaded_.begin(), uploaded_.end(),
                    [](const RigHistory* rig) { return rig->learnt_instants() >= baked_from; });
    learn(level_.is_refined || !are_known ? uploaded_ : rigs_in_turn());
    make_a_first_model();
    if (now_s_ - looked_s_ >= look_period_s || states_.size() != uploaded_.size()) look_at_sets();
}

void StagedPreparer::warm_up(std::span<const DepthView> views, const VirtualView& target) {
    // Enough instants to bake a background, with enough time between them to refine it.
    match_anew(std::numeric_limits<double>::infinity());
    for (int i = 0; i < baked_from; ++i) take(views, improvement_period_s);
    constexpr PrepareLevel best_of_one{0, 1, true, true};
    (void)prepare(target, prepare_levels().back());
    (void)prepare(target, best_of_one);
    // Refinement of a matched background uses other shaders.
    for (RigHistory* rig : uploaded_) {
        const DepthImage none(rig->depth().size(), 0.0f);
        rig->set_background_match(none, none, ColourImage(none.size()));
    }
    improve(target);
    std::vector<RigHistory*> modelled;
    for (RigHistory* rig : uploaded_)
        if (rig->model()) modelled.push_back(rig);
    while (baker_.step(modelled, target, now_s_, true)) continue;
    baker_.forget();
    level_ = prepare_levels().front();
    rigs_.forget();
    improved_s_ = now_s_;
    match_anew(now_s_ + learnt_before_match_s);
}

void StagedPreparer::cut() {
    rigs_.cut();
    is_after_cut_ = true;
}

void StagedPreparer::keep_only(const std::set<std::string>& rigs) {
    if (!rigs_.keep_only(rigs)) return;
    // Work in progress may refer to them.
    prepared_rigs_.clear();
    refinement_pass_.reset();
    matched_.reset();
    std::erase_if(misfits_, [&](const auto& misfit) { return !rigs.contains(misfit.first); });
    surfaces_.drop_free();
    pictures_.drop_free();
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
    for (RigHistory* rig : uploaded_) {
        const auto misfit = misfits_.find(rig->camera().name);
        const bool is_learnt = rig->learnt_instants() > 0;
        const BackgroundModel::Look look =
            is_learnt ? sets_.look_at(*rig) : BackgroundModel::Look();
        if (look.changed_share > changed_share_to_renew) {
            baker_.bake_anew();
            make_model_due(*rig);
        }
        if (look.changed_share > changed_share_to_patch) {
            baker_.note_change(now_s_);
            if (!level_.is_refined) make_model(*rig, prepare_levels().back());
        }
        states_.push_back({.rig = rig->camera().name,
                           .known = look.known_share,
                           .is_loaded = misfit != misfits_.end() && misfit->second.empty(),
                           .misfit = misfit != misfits_.end() ? misfit->second : "",
                           .matte = look.matte});
    }
}

void StagedPreparer::make_a_first_model() {
    for (RigHistory* rig : uploaded_) {
        const std::optional<RigHistory::Model>& model = rig->model();
        if (rig->learnt_instants() < baked_from) continue;
        const bool is_rough = model && model->rank > 0;
        const int sure =
            is_rough && rig->learnt_instants() >= rough_again_at ? rough_again_at : baked_from;
        if (model && model->made >= sure) continue;
        if (model && model->rank == 0) {
            make_model_due(*rig);
        } else if (!level_.is_refined) {
            make_model(*rig, prepare_levels().back());
            return;
        }
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
    baker_.forget();
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
        refinement_.then([one] { one->generate_mipmaps(); });
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
            show.input("depth_then", one->match()->learnt_m);
            show.input("colour_then", one->match()->colour);
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
            if (rig->learnt_instants() >= baked_from) next.rigs.push_back(rig);
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
    matching_.begin(matched_->sets, matched_size_, manner);
    return false;
}

void StagedPreparer::take_match(std::span<const DepthImage> depths_m) {
    const std::optional<Matched> matched = std::exchange(matched_, std::nullopt);
    if (!matched) return;
    if (std::exchange(matched_size_, MatchedSize::whole) == MatchedSize::half) {
        match_due_s_ = now_s_ + whole_match_rest_s;
    } else {
        match_due_s_ = now_s_ + match_rest_s_;
        match_rest_s_ = std::min(2 * match_rest_s_, longest_match_rest_s);
    }
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
    matched_size_ = MatchedSize::half;
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

const Texture& StagedPreparer::patched_model(const RigHistory& rig) {
    patched_.resize(rig.depth().size());
    Program& patch = patch_.use();
    patch.input("model", rig.model()->surface->depth());
    patch.input("background_state", rig.background_state().state());
    BackgroundModel::set_model_then(patch, rig);
    patch_.draw(patched_.target());
    return patched_.texture();
}

std::deque<MultiViewRefinement::Step> StagedPreparer::model_in_steps(RigHistory& rig,
                                                                     const PrepareLevel& level) {
    const Texture* depth_m = &rig.steady_depth();
    const Texture* measured_m = depth_m;
    const std::optional<RigHistory::Model>& before = rig.model();
    const bool is_patched = !level.is_refined && before && before->rank == 0;
    std::deque<MultiViewRefinement::Step> steps;
    if (level.is_refined)
        steps = refinement_.in_steps([&] { depth_m = &refined_background(rig); });
    else if (is_patched)
        depth_m = &patched_model(rig);
    RigHistory::Model made{.surface = nullptr,
                           .rank = level.rank,
                           .rest_s = first_model_rest_s,
                           .made_s = now_s_,
                           .made = is_patched ? before->made : rig.learnt_instants(),
                           .matches = rig.matches(),
                           .learnt_m = copy_of(*measured_m, TextureFormat::r32f),
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
    if (level.is_refined) refinement_pass_.reset();
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
    program.set("sharpening", sharpening_of(level));
    colour_performers_.draw(surface->colour_target(), rig.matte_tiles().texture(),
                            rig.fresh_colour().size());
    triangles_.build_where(surface->grid(QuadGrid::coarse), rig.matte_tiles().texture(),
                           rig.fresh_colour().size(), level.bend);
    return surface;
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
}

std::shared_ptr<const RigSurface> StagedPreparer::set_of(RigHistory& rig,
                                                         const Texture& performers_m,
                                                         const PrepareLevel& level) {
    const std::shared_ptr<RigSurface> surface = surfaces_.take(shapes_);
    if (is_baked_) {
        surface->begin_like(*baker_.surface_of(rig), rig.samples());
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
    now.set("sharpening", sharpening_of(level));
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

std::shared_ptr<const DrawnTexture> StagedPreparer::picture_now(RigHistory& rig) {
    if (rig.picture_now()) return rig.picture_now();
    const std::shared_ptr<DrawnTexture> picture =
        pictures_.take(TextureFormat::rgba8, Filter::linear, true);
    picture->resize(rig.fresh_colour().size());
    Program& program = picture_now_.use();
    program.input("picture", rig.fresh_colour());
    program.input("background_colour", rig.colour());
    picture_now_.overwrite(picture->target());
    picture->generate_mipmaps();
    rig.set_picture_now(picture);
    return picture;
}

std::shared_ptr<const Instant> StagedPreparer::prepare(const VirtualView& target,
                                                       const PrepareLevel& level) {
    auto instant = std::make_shared<Instant>();
    instant->level = level.rank;
    const std::vector<RigHistory*> rigs = most_useful(rigs_.shown(), target, level.rigs);
    level_ = level;
    prepared_rigs_ = {rigs.begin(), rigs.end()};
    if (level.rank > 0) instant->extra = baker_.baked_for(target);
    is_baked_ = instant->extra != nullptr;
    learn(level.is_refined ? uploaded_ : rigs);
    for (RigHistory* rig : rigs) {
        if (!rig->prepared_rank() || *rig->prepared_rank() > level.rank) publish(*rig, level);
        instant->rigs.push_back({rig->surface(), rig->performers(), rig->presence()});
        if (nearness(rig->camera(), rig->median_depth_m(), target) > 0)
            instant->rigs.back().picture = picture_now(*rig);
    }
    return instant;
}

bool StagedPreparer::bake_a_step(const VirtualView& target, BackgroundStereoTask::Manner manner) {
    // The best level draws no baked background.
    if (level_.rank == 0) return false;
    const auto is_known = [](const RigHistory* rig) {
        return rig->model() && rig->model()->made >= baked_from;
    };
    std::vector<RigHistory*> rigs = rigs_.shown();
    if (!std::all_of(rigs.begin(), rigs.end(), is_known)) return false;
    // Views come in any order.
    std::sort(rigs.begin(), rigs.end(), [](const RigHistory* a, const RigHistory* b) {
        return a->camera().name < b->camera().name;
    });
    return baker_.step(rigs, target, now_s_,
                       manner == BackgroundStereoTask::Manner::when_waited_for);
}

void StagedPreparer::improve(const VirtualView& target) {
    while (improve_a_step(target, BackgroundStereoTask::Manner::when_waited_for)) continue;
    if (const auto depths_m = matching_.take(true)) take_match(*depths_m);
}

bool StagedPreparer::improve_a_step(const VirtualView& target,
                                    BackgroundStereoTask::Manner manner) {
    if (match_a_step(manner)) return true;
    if (refinement_pass_ && !is_under_way(*refinement_pass_)) refinement_pass_.reset();
    // Probes come before better models while pictures of this view cannot use a baked background.
    const bool is_baking_urgent = !baker_.baked_for(target);
    if ((!refinement_pass_ || is_baking_urgent) && bake_a_step(target, manner)) return true;
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
    // The rig whose model has been due for longest; one without a model is due at once, and those
    // in view are refined first.
    const auto due_s = [](const RigHistory& rig) {
        // A model of few instants would be made anew soon.
        if (rig.learnt_instants() < baked_from) return std::numeric_limits<double>::infinity();
        if (!rig.model()) return -1.0;
        return rig.model()->made_s + (rig.model()->rank == 0 ? rig.model()->rest_s : 0);
    };
    RigHistory* oldest = nullptr;
    const auto look_at = [&](RigHistory* rig) {
        if (due_s(*rig) <= now_s_ && (!oldest || due_s(*rig) < due_s(*oldest))) oldest = rig;
    };
    for (RigHistory* rig : most_useful(rigs_.shown(), target, level_.rigs))
        if (!rig->model() || rig->model()->rank > 0) look_at(rig);
    if (!oldest)
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
