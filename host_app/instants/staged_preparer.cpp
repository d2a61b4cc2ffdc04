#include "host_app/instants/staged_preparer.h"

#include <algorithm>

#include <fmt/format.h>

#include "common/base/log.h"
#include "host_app/instants/depth_spread.h"
#include "host_app/instants/rig_presence.h"
#include "host_app/instants/view_ranking.h"

namespace vantage {
namespace {

/// Between two models of a set at the best level, and between two works of improve().
constexpr double model_period_s = 0.5, improvement_period_s = 0.8;
/// Instants, before which there is nothing to remember.
constexpr int remembered_from = 3;
/// Between two looks at how much of the sets is known.
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
      over_(library, "set_over.frag"),
      now_(library, "colours_now.frag") {}

void StagedPreparer::take(std::span<const DepthView> views, double dt_s) {
    now_s_ += dt_s;
    ++instant_;
    uploaded_ = upload_with_fades(views, dt_s, rigs_);
    for (RigHistory* rig : uploaded_) begin_with_learnt(*rig);
    learnt_.clear();
    has_depths_.clear();
    if (std::exchange(is_after_cut_, false)) return;
    learn(uploaded_);
    if (now_s_ - looked_s_ >= look_period_s || states_.size() != uploaded_.size()) look_at_sets();
}

void StagedPreparer::forget() {
    for (const auto& rig : rigs_) rig->forget();
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
        states_.push_back({.rig = rig->camera().name,
                           .known = sets_.known_share(*rig),
                           .is_loaded = misfit != misfits_.end() && misfit->second.empty(),
                           .misfit = misfit != misfits_.end() ? misfit->second : ""});
    }
}

void StagedPreparer::begin_with(std::shared_ptr<const LearntSet> set) {
    begins_with_ = std::move(set);
    misfits_.clear();
    states_.clear();
}

void StagedPreparer::learn_anew() {
    begin_with(nullptr);
    forget();
    is_after_cut_ = false;
}

LearntSet StagedPreparer::learnt() const {
    LearntSet set;
    set.learnt = TaiClock::now();
    for (const auto& rig : rigs_)
        if (rig->learnt_instants() > 0) set.rigs.push_back(SetLearner::learnt(*rig));
    return set;
}

void StagedPreparer::make_model(RigHistory& rig, const PrepareLevel& level) {
    const std::shared_ptr<RigSurface> model = surfaces_.take();
    model->begin(rig.camera(), rig.colour().size(), rig.depth().size(), rig.samples());
    rig.generate_mipmaps();
    const Texture& bettered = level.is_refined
                                  ? consensus_.better_set(compared(rig), compared(rigs_))
                                  : rig.steady_depth();
    closer_.close(bettered, rig.steady_depth(), rig.colour(), model->depth_target());
    rig.set_model({model, level.rank, now_s_, instant_});
}

void StagedPreparer::bind_set(Program& program, const RigHistory& rig) const {
    program.set("model", 0);
    program.set("set_state", 1);
    program.set("since", static_cast<float>(instant_ - rig.model()->made));
    rig.model()->surface->depth().bind(0);
    rig.set_state().state().bind(1);
}

std::shared_ptr<const RigPlate> StagedPreparer::plate_of(RigHistory& rig) {
    const std::shared_ptr<RigPlate> plate = plate_pool_.take();
    const Framebuffer& target = plate->picture(rig.depth().size()).target();
    Program& show = show_.use();
    bind_set(show, rig);
    show.set("colour", 2);
    show.set("colour_mean", 3);
    show.set("known_after", SetLearner::known_after(rig));
    rig.colour().bind(2);
    rig.colour_mean().bind(3);
    show_.draw(target);
    // Elsewhere the rig sees the set now.
    triangles_.build_where(
        {plate->picture().depth_m(),
         plate->triangles_to_build(triangle_indices(rig.depth().size())), rig.K_depth(),
         rig.camera().world_from_camera, QuadGrid::coarse, depth_spread(rig.camera())},
        rig.matte_tiles().texture(), rig.fresh_colour().size());
    return plate;
}

void StagedPreparer::find_performers(RigHistory& rig, const PrepareLevel& level) {
    const auto find = [&](RigHistory& one) {
        if (has_depths_.contains(&one)) return;
        performers_.find(one, learnt_);
        has_depths_.insert(&one);
    };
    // The others' are asked for only where they are compared.
    if (!level.is_refined) return find(rig);
    for (RigHistory* one : uploaded_) find(*one);
}

void StagedPreparer::publish(RigHistory& rig, const PrepareLevel& level) {
    const bool is_best = level.rank == 0;
    if (!rig.model() ||
        (is_best && (rig.model()->rank > 0 || now_s_ - rig.model()->made_s >= model_period_s)))
        make_model(rig, level);
    find_performers(rig, level);
    const Texture& performers =
        level.is_refined ? performers_.better(rig, uploaded_) : rig.performer_depth().texture();
    const std::shared_ptr<RigSurface> surface = surfaces_.take();
    surface->begin(rig.camera(), rig.colour().size(), rig.depth().size(), rig.samples());
    Program& over = over_.use();
    bind_set(over, rig);
    over.set("performers", 2);
    over.set("matte", 3);
    performers.bind(2);
    rig.matte().texture().bind(3);
    over_.draw(surface->depth_target());
    colours_.resize(rig.colour().size());
    Program& now = now_.use();
    now.set("picture", 0);
    now.set("set_colour", 1);
    rig.fresh_colour().bind(0);
    rig.colour().bind(1);
    now_.draw(colours_.target());
    edge_trust_.judge(colours_.texture(), *surface);
    triangles_.build(surface->grid(QuadGrid::coarse));
    if (level.has_fine_grid) {
        triangles_.build(surface->grid(QuadGrid::fine));
        triangles_.build_rims(*surface);
    }
    surface->set_has_fine_grid(level.has_fine_grid);
    if (rig.learnt_instants() >= remembered_from) surface->set_plate(plate_of(rig));
    rig.publish(surface, level.rank);
}

std::shared_ptr<const Instant> StagedPreparer::prepare(const VirtualView& target,
                                                       const PrepareLevel& level) {
    auto instant = std::make_shared<Instant>();
    instant->level = level.rank;
    const std::vector<RigHistory*> rigs = most_useful(rigs_, target, level.rigs);
    learn(level.is_refined ? uploaded_ : rigs);
    for (RigHistory* rig : rigs) {
        if (!rig->prepared_rank() || *rig->prepared_rank() > level.rank) publish(*rig, level);
        instant->rigs.push_back({rig->surface(), nullptr, rig->presence()});
    }
    return instant;
}

void StagedPreparer::improve(const VirtualView& target) {
    if (now_s_ - improved_s_ < improvement_period_s) return;
    // The oldest model of those that are looked at.
    RigHistory* oldest = nullptr;
    for (RigHistory* rig : most_useful(rigs_, target, most_drawn_rigs))
        if (rig->model() && (!oldest || rig->model()->made_s < oldest->model()->made_s))
            oldest = rig;
    if (!oldest) return;
    improved_s_ = now_s_;
    learn(uploaded_);
    make_model(*oldest, prepare_levels().front());
}

}  // namespace vantage
