#include "host_app/programme/synthesiser_switch.h"

#include <algorithm>
#include <utility>

namespace vantage {

SynthesiserSwitch::SynthesiserSwitch(const PictureFormat& format, InstantThread& instants,
                                     const SynthesiserEntry& first)
    : format_(format), instants_(instants), current_(&renderer_of(first)) {}

SynthesiserSwitch::Renderer& SynthesiserSwitch::renderer_of(const SynthesiserEntry& synthesiser) {
    Renderer& renderer = renderers_[synthesiser.name];
    if (!renderer.maker) {
        renderer.synthesiser = synthesiser;
        renderer.maker = std::make_unique<PictureMaker>(synthesiser, format_, instants_.contexts(),
                                                        instants_.render_priority());
    }
    return renderer;
}

void SynthesiserSwitch::begin_next() {
    if (next_) return;
    const std::vector<SynthesiserEntry> all = synthesiser_entries();
    const auto at = std::find_if(all.begin(), all.end(), [&](const SynthesiserEntry& entry) {
        return entry.name == current_->synthesiser.name;
    });
    next_ = &renderer_of(at == all.end() || at + 1 == all.end() ? all.front() : *(at + 1));
}

bool SynthesiserSwitch::follow(const ReadyInstant* newest) {
    if (!next_ || !next_->maker->is_idle()) return false;
    const SynthesiserEntry& wanted = next_->synthesiser;
    instants_.prepare_for(wanted.name, wanted.make_preparer);
    if (!newest || newest->synthesiser != wanted.name) return false;
    current_ = std::exchange(next_, nullptr);
    // A frame may be left from when this renderer was last in use.
    (void)current_->maker->take_finished();
    return true;
}

int SynthesiserSwitch::faults() const {
    int faults = 0;
    for (const auto& [name, renderer] : renderers_) faults += renderer.maker->faults();
    return faults;
}

void StillRefiner::refine(const SynthesiserEntry& synthesiser, const PictureJob& job) {
    std::unique_ptr<PictureMaker>& maker = makers_[synthesiser.name];
    if (!maker)
        maker = std::make_unique<PictureMaker>(synthesiser, format_, instants_.contexts(),
                                               instants_.render_priority(),
                                               PictureMaker::Manner::in_slices);
    if (maker_ != maker.get()) {
        pause(false);
        maker_ = maker.get();
        begun_.reset();
    }
    if (!maker_->is_idle() || (begun_ && is_same_picture(*begun_, job))) return;
    begun_ = job;
    maker_->start(job);
}

void StillRefiner::pause(bool is_paused) {
    if (maker_) maker_->pause(is_paused);
}

std::shared_ptr<const MadePicture> StillRefiner::take_finished() {
    return maker_ ? maker_->take_finished() : nullptr;
}

void StillRefiner::end() {
    maker_ = nullptr;
    makers_.clear();
}

}  // namespace vantage
