#include "host_app/instants/staged_preparer.h"

#include <algorithm>

#include <fmt/format.h>

#include "common/base/log.h"
#include "host_app/instants/depth_spread.h"
#include "host_app/instants/view_ranking.h"

namespace vantage {
namespace {

/// Between two models of a set at the best level, and between two works of improve().
constexpr double model_period_s = 0.5, improvement_period_s = 0.8;
/// Between two searches for thin things in a rig's set: the set is all but still by then.
constexpr double search_period_s = 2;
/// Instants, before which there is nothing to remember.
constexpr int remembered_from = 3;
/// Between two looks at how much of the sets is known, and at the mattes.
constexpr double look_period_s = 1;

}  // namespace

StagedPreparer::StagedPreparer(const ShaderLibrary& library)
    : sets_(library),
      performers_(library),
      consensus_(library),
      closer_(library),
      edge_trust_(library),
      triangles_(library),
      show_(library, "set_show.frag"),
      now_(library, "colours_now.frag"),
      colour_performers_(library, "performer_colour.frag") {}

void StagedPreparer::take(std::span<const DepthView> views, double dt_s) {
    now_s_ += dt_s;
    ++instant_;
    uploaded_ = rigs_.upload(views, dt_s);
    for (RigHistory* rig : uploaded_) begin_with_learnt(*rig);
    learnt_.clear();
    has_depths_.clear();
    if (std::exchange(is_after_cut_, false)) return;
    learn(uploaded_);
    if (now_s_ - looked_s_ >= look_period_s || states_.size() != uploaded_.size()) look_at_sets();
}

void StagedPreparer::rehearse(std::span<const DepthView> views, const VirtualView& target) {
    // So many that there is something to remember, and time to better the set.
    for (int i = 0; i < remembered_from; ++i) take(views, improvement_period_s);
    constexpr PrepareLevel best_of_one{0, 1, true, true};
    (void)prepare(target, prepare_levels().back());
    (void)prepare(target, best_of_one);
    improve(target);
    rigs_.forget();
    improved_s_ = now_s_;
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

void StagedPreparer::begin_with_learnt(RigHistory& rig) {
    if (!begins_with_ || rig.learnt_instants() > 0) return;
    const std::string& name = rig.camera().name;
    const auto found = std::find_if(begins_with_->rigs.begin(), begins_with_->rigs.end(),
                                    [&](const LearntRigSet& set) { return set.rig == name; });
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
        SetLearner::restore(rig, *found);
    if (!misfit.empty() && misfits_[name] != misfit) log_warning("{}", misfit);
    misfits_[name] = misfit;
}

void StagedPreparer::look_at_sets() {
    looked_s_ = now_s_;
    states_.clear();
    for (const RigHistory* rig : uploaded_) {
        const auto misfit = misfits_.find(rig->camera().name);
        const SetLearner::Look look = sets_.look_at(*rig);
        states_.push_back({.rig = rig->camera().name,
                           .known = look.known_share,
                           .is_loaded = misfit != misfits_.end() && misfit->second.empty(),
                           .misfit = misfit != misfits_.end() ? misfit->second : "",
                           .matte = look.matte});
    }
}

void StagedPreparer::begin_with(std::shared_ptr<const LearntSet> set) {
    begins_with_ = std::move(set);
    misfits_.clear();
    states_.clear();
}

void StagedPreparer::learn_anew() {
    begin_with(nullptr);
    rigs_.forget();
}

LearntSet StagedPreparer::learnt() const {
    LearntSet set;
    set.learnt = TaiClock::now();
    for (const RigHistory* rig : rigs_.known())
        if (rig->learnt_instants() > 0) set.rigs.push_back(SetLearner::learnt(*rig));
    return set;
}

const Texture& StagedPreparer::bettered_set(RigHistory& rig) {
    const ComparedView view = compared(rig);
    const std::vector<ComparedView> all = compared(rigs_.shown());
    const Texture& bettered = consensus_.better_set(view, all);
    if (!rig.searched_s() || now_s_ - *rig.searched_s() >= search_period_s) {
        rig.found().resize(bettered.size());
        if (consensus_.search(view, all, bettered, rig.found().target()))
            rig.set_searched_s(now_s_);
    }
    return rig.searched_s() ? consensus_.with_found(view, bettered, rig.found().texture())
                            : bettered;
}

void StagedPreparer::make_model(RigHistory& rig, const PrepareLevel& level) {
    const std::shared_ptr<RigSurface> model = surfaces_.take();
    model->begin(rig.camera(), rig.colour().size(), rig.depth().size(), rig.samples());
    rig.generate_mipmaps();
    const Texture& bettered = level.is_refined ? bettered_set(rig) : rig.steady_depth();
    closer_.close(bettered, rig.steady_depth(), rig.colour(), model->depth_target());
    rig.set_model({model, level.rank, now_s_, instant_});
}

void StagedPreparer::bind_set(Program& program, const RigHistory& rig) const {
    program.set("model", 0);
    program.set("set_state", 1);
    // What has not changed for as long as is counted has not changed since an older model either.
    program.set("since", std::min(static_cast<float>(instant_ - rig.model()->made),
                                  SetLearner::most_votes(rig) - 1));
    rig.model()->surface->depth().bind(0);
    rig.set_state().state().bind(1);
}

std::shared_ptr<const RigSurface> StagedPreparer::performers_of(RigHistory& rig,
                                                                const PrepareLevel& level) {
    const std::shared_ptr<RigSurface> surface = surfaces_.take();
    surface->begin(rig.camera(), rig.colour().size(), rig.depth().size(), rig.samples());
    if (level.is_refined) {
        for (RigHistory* one : uploaded_) {
            if (has_depths_.contains(one)) continue;
            one->performer_depth().resize(one->depth().size());
            performers_.find(*one, learnt_, one->performer_depth().target());
            has_depths_.insert(one);
        }
        performers_.better(rig, uploaded_, surface->depth_target());
    } else {
        performers_.find(rig, learnt_, surface->depth_target());
    }
    Program& program = colour_performers_.use();
    program.set("picture", 0);
    program.set("set_colour", 1);
    program.set("matte", 2);
    rig.fresh_colour().bind(0);
    rig.colour().bind(1);
    rig.matte().texture().bind(2);
    colour_performers_.draw(surface->colour_target(), rig.matte_tiles().texture(), 3,
                            rig.fresh_colour().size());
    triangles_.build_where(surface->grid(QuadGrid::coarse), rig.matte_tiles().texture(),
                           rig.fresh_colour().size());
    return surface;
}

std::shared_ptr<const RigSurface> StagedPreparer::set_of(RigHistory& rig,
                                                         const Texture& performers_m,
                                                         const PrepareLevel& level) {
    const std::shared_ptr<RigSurface> surface = surfaces_.take();
    surface->begin(rig.camera(), rig.colour().size(), rig.depth().size(), rig.samples());
    Program& show = show_.use();
    bind_set(show, rig);
    show.set("depth_map", 2);
    show.set("seen", 3);
    show.set("performers", 4);
    show.set("colour", 5);
    show.set("colour_mean", 6);
    show.set("known_after", SetLearner::known_after(rig));
    rig.depth().bind(2);
    rig.set_state().seen().bind(3);
    performers_m.bind(4);
    rig.colour().bind(5);
    rig.colour_mean().bind(6);
    show_.draw(surface->depth_target());
    colours_.resize(rig.colour().size());
    Program& now = now_.use();
    now.set("picture", 0);
    now.set("set_colour", 1);
    now.set("performers", 2);
    now.set("seen", 3);
    now.set("matte", 4);
    now.set("set_depth", 5);
    now.set("remembered", RigSurface::remembered_trust);
    rig.fresh_colour().bind(0);
    rig.colour().bind(1);
    performers_m.bind(2);
    rig.set_state().seen().bind(3);
    rig.matte().texture().bind(4);
    surface->depth().bind(5);
    now_.draw(colours_.target());
    edge_trust_.judge(colours_.texture(), *surface);
    triangles_.build(surface->grid(QuadGrid::coarse));
    if (level.has_fine_grid) {
        triangles_.build(surface->grid(QuadGrid::fine));
        triangles_.build_rims(*surface);
    }
    surface->set_has_fine_grid(level.has_fine_grid);
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
    learn(level.is_refined ? uploaded_ : rigs);
    for (RigHistory* rig : rigs) {
        if (!rig->prepared_rank() || *rig->prepared_rank() > level.rank) publish(*rig, level);
        instant->rigs.push_back({rig->surface(), rig->performers(), rig->presence()});
    }
    return instant;
}

void StagedPreparer::improve(const VirtualView& target) {
    if (now_s_ - improved_s_ < improvement_period_s) return;
    // The oldest model of those that are looked at.
    RigHistory* oldest = nullptr;
    for (RigHistory* rig : most_useful(rigs_.shown(), target, most_drawn_rigs))
        if (rig->model() && (!oldest || rig->model()->made_s < oldest->model()->made_s))
            oldest = rig;
    if (!oldest) return;
    improved_s_ = now_s_;
    learn(uploaded_);
    make_model(*oldest, prepare_levels().front());
}

}  // namespace vantage
