#include "rig_firmware/stereo/engine_matcher.h"

namespace vantage {

EngineMatcher::EngineMatcher(const ShaderLibrary& library, const MatchSettings& settings)
    : luma_(library, layout_of(settings)),
      result_(library, layout_of(settings), settings.confidence) {}

const Texture& EngineMatcher::match(const Texture& left, const Texture& right) {
    profiler_.begin_frame();
    luma_.run(profiler_, left, right);
    const Buffer& disparity = search(profiler_, luma_);
    const Texture& result = result_.run(profiler_, disparity);
    profiler_.end_frame();
    return result;
}

const Buffer& CheckAndFill::run(PassProfiler& profiler, const Buffer& winners,
                                const Buffer* weight) {
    check_.run(profiler, winners, weight);
    if (fills_) {
        support_.run(profiler, check_.disparity(), check_.scratch());
        fill_.run(profiler, check_.disparity(), check_.scratch());
    }
    const Buffer &disparity = fills_ ? check_.scratch() : check_.disparity(),
                 &medians = fills_ ? check_.disparity() : check_.scratch();
    smooth_.run(profiler, disparity);
    median_.run(profiler, disparity, medians);
    return medians;
}

}  // namespace vantage
