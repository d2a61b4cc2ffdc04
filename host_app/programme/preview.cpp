#include "host_app/programme/preview.h"

#include <algorithm>

namespace vantage {
namespace {

/// Largest share of the time that frames of the preview take.
constexpr double busy_share = 0.33;
/// Longest pause after a frame, since a frame that compiled or waited for a reset is an exception.
constexpr std::chrono::nanoseconds max_pause = std::chrono::seconds(1);
/// Largest share of a tick for a frame at a better level.
constexpr double max_tick_share = 0.2;

PictureFormat half_of(const PictureFormat& format) {
    return {std::max(2, format.width_px / 2), std::max(2, format.height_px / 2), {}};
}

}  // namespace

Preview::Preview(const PictureFormat& programme, double rate_hz, ContextGroup& contexts,
                 RenderPriority& priority)
    : format_(half_of(programme)),
      tick_ms_(1000 / rate_hz),
      contexts_(&contexts),
      priority_(&priority),
      level_(render_levels().size(), max_tick_share) {
    level_.begin_with_the_cheapest();
}

void Preview::take_finished(MonotonicTime now) {
    if (!is_under_way_ || !maker_->is_idle()) return;
    is_under_way_ = false;
    const MonotonicTime::duration took = now - began_;
    next_ =
        now +
        std::min(std::chrono::duration_cast<std::chrono::nanoseconds>((1 / busy_share - 1) * took),
                 max_pause);
    std::shared_ptr<const MadePicture> made = maker_->take_finished();
    if (!made) return;
    shown_ = std::move(made);
    ++pictures_;
    last_make_ms_ = to_ms(took);
    level_.saw(level_.level(), last_make_ms_, tick_ms_, now);
}

void Preview::follow(const std::optional<OrbitView>& view, const SynthesiserEntry& synthesiser,
                     const std::shared_ptr<const ReadyInstant>& instant, bool may_begin,
                     MonotonicTime now) {
    if (maker_) take_finished(now);
    if (!view) {
        shown_.reset();
        begun_.reset();
        return;
    }
    if (is_under_way_) return;
    std::unique_ptr<PictureMaker>& maker = makers_[synthesiser.name];
    if (!maker)
        maker = std::make_unique<PictureMaker>(synthesiser, format_, *contexts_, *priority_,
                                               PictureMaker::Manner::in_slices);
    maker_ = maker.get();
    if (!may_begin || now < next_ || !instant || instant->synthesiser != maker_->synthesiser() ||
        !maker_->is_idle())
        return;
    PictureJob job{instant, view->camera(), render_levels()[level_.level()]};
    if (begun_ && is_same_picture(*begun_, job)) return;
    begun_ = job;
    began_ = now;
    is_under_way_ = true;
    maker_->start(std::move(job));
}

void Preview::pause(bool is_paused) {
    if (maker_) maker_->pause(is_paused);
}

void Preview::end() {
    maker_ = nullptr;
    makers_.clear();
}

}  // namespace vantage
