#include "host_app/fused/background_baker.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "common/base/this_thread.h"
#include "common/base/trace/trace.h"
#include "host_app/baked/baked_painter.h"
#include "host_app/views/view_ranking.h"

namespace vantage {
namespace {

/// Time before a probe is baked again for newer background models: the first time, and doubled each
/// time up to the longest, as models of a still background change ever less.
constexpr double first_probe_rest_s = 8, longest_probe_rest_s = 64;

bool is_same_rig(const ProbeRig& a, const ProbeRig& b) {
    return a.K == b.K && a.size == b.size &&
           a.world_from_camera.matrix() == b.world_from_camera.matrix();
}

}  // namespace

BackgroundBaker::BackgroundBaker(const ShaderLibrary& library)
    : layers_(library),
      candidates_pass_(library, "probe_candidates.frag", same_surface_share),
      edge_confidence_(library),
      triangles_(library),
      learnt_colours_(library, "learnt_colours.frag") {}

void BackgroundBaker::forget() {
    drawing_.reset();
    on_gpu_.reset();
    on_thread_.reset();
    modelled_.clear();
    surfaces_.drop_free();
    placed_for_.clear();
    baked_.reset();
    for (Probe& probe : std::exchange(probes_, {})) retire(std::move(probe.made));
    changed_s_ = -1;
}

void BackgroundBaker::retire(std::shared_ptr<const BackgroundProbe> probe) {
    if (probe) retired_.push_back(std::move(probe));
}

void BackgroundBaker::release_unused() {
    std::erase_if(retired_, [](const auto& probe) { return probe.use_count() == 1; });
}

void BackgroundBaker::bake_anew() {
    for (Probe& probe : probes_) probe.rest_s = 0;
}

void BackgroundBaker::note_change(double now_s) {
    changed_s_ = now_s;
    bake_anew();
}

std::shared_ptr<const RigSurface> BackgroundBaker::surface_of(const RigHistory& rig) {
    ModelSurface& kept = modelled_[rig.camera().name];
    const std::shared_ptr<const RigSurface>& model = rig.model()->surface;
    if (kept.model == model) return kept.surface;
    const std::shared_ptr<RigSurface> surface = surfaces_.take(shapes_);
    surface->begin_like(*model, rig.samples());
    edge_confidence_.judge(*surface);
    for (const QuadGrid grid : {QuadGrid::coarse, QuadGrid::fine})
        triangles_.build(surface->grid(grid));
    triangles_.build_rims(*surface);
    surface->set_has_fine_grid(true);
    Program& program = learnt_colours_.use();
    program.input("background_colour", rig.colour());
    program.input("confidence", surface->confidence().texture());
    learnt_colours_.draw(surface->colour_target());
    surface->finish_colour();
    kept = {model, surface, nullptr};
    return surface;
}

void BackgroundBaker::place_probes(std::span<RigHistory* const> rigs) {
    std::vector<ProbeRig> cameras;
    for (const RigHistory* rig : rigs)
        cameras.push_back(
            {rig->camera().K, rig->camera().world_from_camera, rig->fresh_colour().size()});
    if (std::equal(cameras.begin(), cameras.end(), placed_for_.begin(), placed_for_.end(),
                   is_same_rig))
        return;
    const double changed_s = changed_s_;
    forget();
    changed_s_ = changed_s;
    const std::vector<VirtualView> views = probe_views(cameras);
    for (const VirtualView& view : views) probes_.push_back({view, nullptr});
    parallax_px_m_ = largest_parallax_px_m(views);
    placed_for_ = std::move(cameras);
}

std::vector<std::size_t> BackgroundBaker::nearest_first(const VirtualView& view) const {
    std::vector<std::size_t> nearest(probes_.size());
    std::iota(nearest.begin(), nearest.end(), 0);
    std::sort(nearest.begin(), nearest.end(), [&](std::size_t a, std::size_t b) {
        return way_m(probes_[a].view, view) < way_m(probes_[b].view, view);
    });
    return nearest;
}

std::shared_ptr<const BakedExtra> BackgroundBaker::baked_for(const VirtualView& target) const {
    if (!baked_) return nullptr;
    std::vector<std::size_t> needed = nearest_first(target);
    const std::size_t drawn = std::min(needed.size(), BakedPainter::most_probes);
    // While one beside it is missing, the next one on either side replaces it.
    needed.resize(std::min(needed.size(), 2 * drawn));
    const auto current = std::count_if(needed.begin(), needed.end(), [&](std::size_t probe) {
        return is_current(probes_[probe]);
    });
    return static_cast<std::size_t>(current) >= drawn ? baked_ : nullptr;
}

void BackgroundBaker::begin(std::span<RigHistory* const> rigs, const VirtualView& target,
                            double now_s) {
    double modelled_s = 0;
    bool is_rough = false;
    bool knows_matches = true;
    int matches = 0;
    for (const RigHistory* rig : rigs) {
        knows_matches = knows_matches && rig->model()->matches == rig->matches();
        matches += rig->model()->matches;
        modelled_s = std::max(modelled_s, rig->model()->made_s);
        is_rough = is_rough || rig->model()->rank > 0;
    }
    std::vector<std::size_t> wanted = nearest_first(target);
    // Rough models are soon replaced: only what is drawn now pays.
    if (is_rough) wanted.resize(std::min(wanted.size(), BakedPainter::most_probes));
    for (const std::size_t i : wanted) {
        const Probe& probe = probes_[i];
        const bool is_due = !is_current(probe) || (probe.is_rough && !is_rough) ||
                            (knows_matches && probe.matches < matches) ||
                            (probe.made_s < modelled_s && now_s - probe.made_s >= probe.rest_s);
        if (!is_due) continue;
        Drawing drawing;
        drawing.probe = i;
        drawing.begun_s = now_s;
        drawing.is_rough = is_rough;
        drawing.matches = matches;
        for (const RigHistory* rig : most_useful(rigs, probe.view, most_drawn_rigs))
            drawing.rigs.push_back(rig->camera().name);
        if (drawing.rigs.empty()) continue;
        drawing_ = std::move(drawing);
        return;
    }
}

bool BackgroundBaker::draw(std::span<RigHistory* const> rigs) {
    Drawing& now = *drawing_;
    const VirtualView& view = probes_[now.probe].view;
    if (now.surfaces.size() < now.rigs.size()) {
        const std::string& name = now.rigs[now.surfaces.size()];
        const auto rig = std::find_if(rigs.begin(), rigs.end(), [&](const RigHistory* one) {
            return one->camera().name == name;
        });
        if (rig == rigs.end()) {
            drawing_.reset();
            return false;
        }
        now.surfaces.push_back(surface_of(**rig));
        return true;
    }
    if (now.drawn == 0) {
        std::vector<DrawnLayer> layers;
        for (const auto& surface : now.surfaces) layers.push_back({surface.get()});
        layers_.begin(layers, view);
    }
    if (now.drawn < now.surfaces.size()) {
        layers_.draw_layer(now.drawn++, now.is_rough ? QuadGrid::coarse : QuadGrid::fine);
        return true;
    }
    draw_candidates();
    return true;
}

void BackgroundBaker::draw_candidates() {
    on_gpu_ = std::exchange(drawing_, std::nullopt);
    const VirtualView& view = probes_[on_gpu_->probe].view;
    candidates_m_.resize({view.width_px, view.height_px});
    candidates_pass_.use(layers_, false).overwrite(candidates_m_.target());
    candidates_drawn_ = Fence::insert();
}

std::shared_ptr<const BackgroundPicture> BackgroundBaker::picture_of(const std::string& rig) {
    ModelSurface& kept = modelled_[rig];
    if (!kept.picture)
        kept.picture = std::make_shared<const BackgroundPicture>(BackgroundPicture{
            kept.surface->camera(), ColourImage(kept.surface->colour().download()),
            DepthImage(kept.surface->depth().download())});
    return kept.picture;
}

void BackgroundBaker::choose() {
    on_thread_ = std::exchange(on_gpu_, std::nullopt);
    std::vector<std::shared_ptr<const BackgroundPicture>> pictures;
    for (const std::string& rig : on_thread_->rigs) pictures.push_back(picture_of(rig));
    tiles_ = std::async(
        std::launch::async,
        [view = probes_[on_thread_->probe].view, pictures = std::move(pictures),
         candidates_m = cv::Mat4f(candidates_m_.texture().download()), parallax = parallax_px_m_] {
            name_this_thread("bg probe");
            const TraceSpan span("background probe");
            return probe_tiles(view, probe_surface(view, candidates_m, pictures), parallax);
        });
}

void BackgroundBaker::take_over(const ProbeTiles& tiles) {
    Probe& probe = probes_[on_thread_->probe];
    const bool was_refined = probe.made && !probe.is_rough;
    probe.rest_s = was_refined
                       ? std::clamp(2 * probe.rest_s, first_probe_rest_s, longest_probe_rest_s)
                       : first_probe_rest_s;
    retire(std::exchange(probe.made, std::make_shared<const BackgroundProbe>(tiles)));
    probe.made_s = on_thread_->begun_s;
    probe.is_rough = on_thread_->is_rough;
    probe.matches = on_thread_->matches;
    auto extra = std::make_shared<BakedExtra>();
    for (const Probe& one : probes_)
        if (one.made) extra->background.probes.push_back(one.made);
    baked_ = std::move(extra);
}

bool BackgroundBaker::step(std::span<RigHistory* const> rigs, const VirtualView& target,
                           double now_s, bool waits) {
    if (rigs.empty()) return false;
    place_probes(rigs);
    if (tiles_.valid()) {
        if (!waits && tiles_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
            return false;
        const ProbeTiles tiles = tiles_.get();
        if (on_thread_) take_over(tiles);
        on_thread_.reset();
        return true;
    }
    if (on_gpu_) {
        // The thread has instants to prepare while the GPU draws.
        if (!waits && !candidates_drawn_.reached()) return false;
        choose();
        return waits;
    }
    if (!drawing_) begin(rigs, target, now_s);
    return drawing_ && draw(rigs);
}

}  // namespace vantage
