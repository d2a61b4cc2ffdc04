#include "rig_firmware/stereo/engine_matcher.h"

namespace vantage {

EngineMatcher::EngineMatcher(const ShaderLibrary& library, const MatchSettings& settings)
    : luma_(library, layout_of(settings)),
      smooth_(library, layout_of(settings)),
      result_(library, layout_of(settings), settings.confidence) {}

const Texture& EngineMatcher::match(const Texture& left, const Texture& right) {
    profiler_.begin_frame();
    luma_.run(profiler_, left, right);
    const Buffer& disparity = search(profiler_, luma_);
    smooth_.run(profiler_, disparity);
    const Texture& result = result_.run(profiler_, disparity);
    profiler_.end_frame();
    return result;
}

const Buffer& CheckAndFill::run(PassProfiler& profiler, const Buffer& winners,
                                const Buffer* weight) {
    check_.run(profiler, winners, weight);
    if (!fills_) return check_.disparity();
    support_.run(profiler, check_.disparity(), check_.scratch());
    fill_.run(profiler, check_.disparity(), check_.scratch());
    return check_.scratch();
}

}  // namespace vantage
