#include <algorithm>
#include <array>
#include <utility>

#include "common/base/error.h"
#include "rig_firmware/stereo/matcher.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/thesis/settings.h"
#include "rig_firmware/stereo/thesis/thesis_passes.h"

namespace vantage {
namespace {

/// A cost volume buffer grows to this before the search is cut into batches of disparities, which
/// bounds the memory and keeps a batch in the cache through all aggregation passes.
constexpr std::size_t wanted_batch_bytes = std::size_t{8} << 20;

std::size_t pixels_of(const MatchSettings& settings) {
    return static_cast<std::size_t>(settings.width_px) *
           static_cast<std::size_t>(settings.height_px);
}

int slices_per_batch(const MatchSettings& settings) {
    const std::size_t slice_bytes = pixels_of(settings) * thesis::bytes_per_element;
    GLint largest_block = 0;
    glGetIntegerv(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &largest_block);
    if (slice_bytes > static_cast<std::size_t>(largest_block))
        fail(
            "pictures of {}x{} need storage buffers of {} bytes, and this GPU takes {}; match "
            "smaller pictures",
            settings.width_px, settings.height_px, slice_bytes, largest_block);
    const int fitting = static_cast<int>(wanted_batch_bytes / slice_bytes);
    return std::clamp(fitting, 1, thesis::slices_for(settings.disparities));
}

Buffer word_buffer(const MatchSettings& settings) {
    return Buffer(pixels_of(settings) * 4, GL_DYNAMIC_COPY);
}

Buffer cost_buffer(const MatchSettings& settings, int slices) {
    return Buffer(
        pixels_of(settings) * thesis::bytes_per_element * static_cast<std::size_t>(slices),
        GL_DYNAMIC_COPY);
}

/// The disparity pipeline of the founding thesis (after Gong & Yang 2005): absolute differences,
/// aggregated again and again without crossing the discontinuities of the filtered left picture,
/// winner takes all.
class GradientMatcher final : public Matcher {
  public:
    GradientMatcher(const ShaderLibrary& library, const MatchSettings& settings)
        : size_(settings.width_px, settings.height_px),
          disparities_(settings.disparities),
          thesis_(thesis::settings_for(settings.preset)),
          batch_slices_(slices_per_batch(settings)),
          to_words_(library, size_),
          snf_(library, size_),
          find_discontinuities_(library, size_),
          hypotheses_(library, size_, disparities_),
          aggregation_(library, size_),
          winner_(library, size_),
          to_disparity_(library, size_, settings.fill),
          left_(word_buffer(settings)),
          right_(word_buffer(settings)),
          filtered_{word_buffer(settings), word_buffer(settings)},
          discontinuities_(word_buffer(settings)),
          keys_(word_buffer(settings)),
          costs_{cost_buffer(settings, batch_slices_), cost_buffer(settings, batch_slices_)} {}

    const Texture& match(const Texture& left, const Texture& right) override {
        profiler_.begin_frame();
        profiler_.run("pictures", to_words_.cost(), [&] { to_words_.run(left, left_); });
        profiler_.run("pictures", to_words_.cost(), [&] { to_words_.run(right, right_); });
        map_discontinuities();
        for (int slice = 0; slice < thesis::slices_for(disparities_); slice += batch_slices_)
            search(slice);
        const Texture* disparity = nullptr;
        profiler_.run("disparity", to_disparity_.cost(),
                      [&] { disparity = &to_disparity_.run(keys_); });
        profiler_.end_frame();
        return *disparity;
    }

    std::vector<PassReport> passes() const override { return profiler_.reports(); }
    void set_profiling(bool on) override { profiler_.set_enabled(on); }

    std::size_t gpu_bytes() const override {
        std::size_t bytes = to_disparity_.gpu_bytes() + cost_volume_bytes();
        for (const Buffer* buffer :
             {&left_, &right_, &filtered_[0], &filtered_[1], &discontinuities_, &keys_})
            bytes += buffer->bytes();
        return bytes;
    }
    std::size_t cost_volume_bytes() const override { return costs_[0].bytes() + costs_[1].bytes(); }

  private:
    void map_discontinuities() {
        const Buffer* picture = &left_;
        for (int i = 0; i < thesis_.snf_iterations; ++i) {
            const Buffer& result = filtered_[static_cast<std::size_t>(i % 2)];
            profiler_.run("snf", snf_.cost(), [&] { snf_.run(*picture, result); });
            picture = &result;
        }
        profiler_.run("discontinuities", find_discontinuities_.cost(), [&] {
            find_discontinuities_.run(*picture, thesis_.discontinuity_threshold, discontinuities_);
        });
    }

    /// One batch of disparities from `first_slice` on, into keys_.
    void search(int first_slice) {
        const int slices = std::min(batch_slices_, thesis::slices_for(disparities_) - first_slice);
        const int first_disparity = first_slice * thesis::disparities_per_slice;
        profiler_.run("hypotheses", hypotheses_.cost(slices),
                      [&] { hypotheses_.run(left_, right_, first_disparity, slices, costs_[0]); });
        for (int i = 0; i < thesis_.aggregation_passes; ++i) {
            profiler_.run("aggregation", aggregation_.cost(slices), [&] {
                aggregation_.run(costs_[0], discontinuities_, slices, costs_[1]);
            });
            std::swap(costs_[0], costs_[1]);
        }
        profiler_.run("winner", winner_.cost(slices),
                      [&] { winner_.run(costs_[0], first_disparity, slices, keys_); });
    }

    cv::Size size_;
    int disparities_;
    thesis::Settings thesis_;
    int batch_slices_;
    thesis::PictureWordsPass to_words_;
    thesis::SnfPass snf_;
    thesis::DiscontinuityPass find_discontinuities_;
    thesis::HypothesesPass hypotheses_;
    thesis::AggregationPass aggregation_;
    thesis::WinnerPass winner_;
    thesis::DisparityPass to_disparity_;
    Buffer left_, right_;
    std::array<Buffer, 2> filtered_;
    Buffer discontinuities_, keys_;
    std::array<Buffer, 2> costs_;
    PassProfiler profiler_;
};

}  // namespace

MatcherEntry gradient_matcher_entry() {
    return {
        .name = "gradient",
        .summary =
            "the thesis' matcher: absolute differences, gradient-guided aggregation (2, 8 or 40 "
            "passes by preset), winner takes all",
        .make = [](const ShaderLibrary& library, const MatchSettings& settings) {
            return std::make_unique<GradientMatcher>(library, settings);
        }};
}

}  // namespace vantage
