#pragma once

#include <optional>
#include <vector>

#include "rig_firmware/stereo/disparity/left_right_pass.h"
#include "rig_firmware/stereo/disparity/median_pass.h"
#include "rig_firmware/stereo/disparity/path_fill_pass.h"
#include "rig_firmware/stereo/disparity/result_pass.h"
#include "rig_firmware/stereo/disparity/row_fill_pass.h"
#include "rig_firmware/stereo/disparity/smooth_pass.h"
#include "rig_firmware/stereo/features/feature_pass.h"
#include "rig_firmware/stereo/features/luma_pass.h"
#include "rig_firmware/stereo/matcher.h"

namespace vantage {

/// What the engine's matchers share: luma of the pictures before the search, the textures of the
/// result after it, and the book-keeping.
class EngineMatcher : public Matcher {
  public:
    const Texture& match(const Texture& left, const Texture& right) final;
    void forget() final {
        luma_.forget();
        forget_search();
    }
    const Texture* confidence() const final { return result_.confidence(); }
    std::vector<PassReport> passes() const final { return profiler_.reports(); }
    void set_profiling(bool on) final { profiler_.set_enabled(on); }
    std::size_t gpu_bytes() const final {
        return luma_.gpu_bytes() + result_.gpu_bytes() + search_bytes();
    }

  protected:
    /// form: of the buffer that search() returns.
    EngineMatcher(const ShaderLibrary& library, const MatchSettings& settings,
                  DisparityForm form = DisparityForm::words);

    /// From the pictures' lumas to a disparity for each of their pixels.
    virtual const Buffer& search(PassProfiler& profiler, const LumaPass& luma) = 0;
    /// Matcher::forget() for the search.
    virtual void forget_search() = 0;
    /// GL objects of the search.
    virtual std::size_t search_bytes() const = 0;

  private:
    PassProfiler profiler_;
    LumaPass luma_;
    ResultPass result_;
};

/// How what a search leaves unknown is filled: not at all, by RowFillPass, or by PathFillPass in
/// cells of one or two pixels.
enum class Fill { none, along_rows, along_paths_of_one_px, along_paths_of_two_px };

/// Of matchers that search every pixel.
inline Fill fill_at_full_size(const MatchSettings& settings) {
    return settings.fill ? Fill::along_paths_of_two_px : Fill::none;
}

/// What follows a search at its own size: left-right check, then a fill, then smoothing and a
/// median.
class CheckAndFill {
  public:
    /// valley, most_step: see LeftRightPass and SmoothPass.
    CheckAndFill(const ShaderLibrary& library, const StereoLayout& layout, Fill fill,
                 Valley valley = Valley::sharp, int most_step = disparity_steps_per_px);

    /// luma: of the left picture at the search's size, in LumaPass's form.
    const Buffer& run(PassProfiler& profiler, const Buffer& luma, const Buffer& winners,
                      const Buffer* weight) {
        check(profiler, winners, weight);
        return fill(profiler, luma);
    }
    /// The two halves of run(): what the check leaves may be changed before the fill.
    const Buffer& check(PassProfiler& profiler, const Buffer& winners, const Buffer* weight);
    const Buffer& fill(PassProfiler& profiler, const Buffer& luma);
    std::size_t gpu_bytes() const {
        return check_.gpu_bytes() + (path_fill_ ? path_fill_->gpu_bytes() : 0) +
               smooth_.gpu_bytes();
    }

  private:
    LeftRightPass check_;
    std::optional<RowFillPass> row_fill_;
    std::optional<PathFillPass> path_fill_;
    SmoothPass smooth_;
    MedianPass median_;
};

inline PictureKind picture_kind(const MatchSettings& settings) {
    return settings.of_stream ? PictureKind::of_stream : PictureKind::single;
}

inline StereoLayout layout_of(const MatchSettings& settings) {
    return {settings.width_px, settings.height_px};
}

/// The entry of a matcher that is constructed from library and settings.
template <class M>
MatcherEntry engine_entry(const char* name, const char* summary) {
    return {name, summary,
            [](const ShaderLibrary& library,
               const MatchSettings& settings) -> std::unique_ptr<Matcher> {
                require_match_limits(settings);
                return std::make_unique<M>(library, settings);
            }};
}

}  // namespace vantage
