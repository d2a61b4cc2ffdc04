#include "rig_firmware/stereo/engine_matcher.h"

#include <utility>

namespace vantage {

EngineMatcher::EngineMatcher(const ShaderLibrary& library, const MatchSettings& settings,
                             DisparityForm form)
    : luma_(library, layout_of(settings), picture_kind(settings)),
      result_(library, layout_of(settings), settings.confidence, form) {}

const Texture& EngineMatcher::match(const Texture& left, const Texture& right) {
    profiler_.begin_frame();
    luma_.run(profiler_, left, right);
    const Buffer& disparity = search(profiler_, luma_);
    const Texture& result = result_.run(profiler_, disparity);
    profiler_.end_frame();
    return result;
}

CheckAndFill::CheckAndFill(const ShaderLibrary& library, const StereoLayout& layout, Fill fill,
                           Valley valley, int most_step)
    : check_(library, layout, valley),
      smooth_(library, layout, most_step),
      median_(library, layout) {
    if (fill == Fill::along_rows) row_fill_.emplace(library, layout);
    if (fill == Fill::along_paths_of_one_px) path_fill_.emplace(library, layout, FillCell::one_px);
    if (fill == Fill::along_paths_of_two_px) path_fill_.emplace(library, layout, FillCell::two_px);
}

const Buffer& CheckAndFill::check(PassProfiler& profiler, const Buffer& winners,
                                  const Buffer* weight) {
    check_.run(profiler, winners, weight);
    return check_.disparity();
}

const Buffer& CheckAndFill::fill(PassProfiler& profiler, const Buffer& luma) {
    const Buffer *disparity = &check_.disparity(), *other = &check_.scratch();
    if (row_fill_) row_fill_->run(profiler, *disparity, *other);
    if (path_fill_) path_fill_->run(profiler, luma, *disparity, *other);
    if (row_fill_ || path_fill_) std::swap(disparity, other);
    smooth_.run(profiler, *disparity);
    median_.run(profiler, *disparity, *other);
    return *other;
}

}  // namespace vantage
