#include "common/base/error.h"
#include "common/config/rig_config.h"
#include "rig_firmware/capture/material/pulse_pacer.h"
#include "rig_firmware/capture/material/stereo_material.h"
#include "rig_firmware/capture/material/virtual_skew.h"
#include "rig_firmware/capture/stereo_source.h"

namespace vantage {
namespace {

/// Source that plays recorded stereo images on the pulses of the stage's clock.
class FilesSource final : public StereoSource {
  public:
    explicit FilesSource(const RigConfig& config)
        : material_(open_material(config.source)),
          pacer_(PulseGrid(config.source.rate_hz)),
          skew_(config, material_->size()),
          rate_hz_(PulseGrid(config.source.rate_hz).rate_hz()) {}

    cv::Size size() const override { return material_->size(); }
    double material_rate_hz() const override { return material_->rate_hz(); }

    std::optional<StereoFrame> next(std::chrono::nanoseconds timeout) override {
        if (ended_) return std::nullopt;
        const std::optional<Pulse> pulse = pacer_.wait_next(timeout);
        if (!pulse) return std::nullopt;
        std::optional<StereoPair> pair = material_->pair_of(pulse->index);
        if (!pair) {
            ended_ = true;
            missed_ += material_->unshown();
            return std::nullopt;
        }
        skew_.draw_bar(pair->left, pair->right, pulse->time);
        missed_ = pacer_.missed();
        return StereoFrame{.trigger_index = pulse->index,
                           .synchronized = true,
                           .exposure = pulse->time,
                           .exposed = pulse->monotonic,
                           .left = std::move(pair->left),
                           .right = std::move(pair->right),
                           .exact_disparity = {}};
    }

    bool ended() const override { return ended_; }
    bool works_on_demand() const override { return true; }
    std::uint64_t missed() const override { return missed_; }
    std::vector<SourceCounter> counters() const override {
        return {{"clock_steps", pacer_.clock_steps()}};
    }
    std::vector<std::string> report() const override {
        return {fmt::format("{}, {}x{} at {} Hz", material_->describe(), size().width,
                            size().height, rate_hz_)};
    }

  private:
    std::unique_ptr<StereoMaterial> material_;
    PulsePacer pacer_;
    VirtualSkew skew_;
    double rate_hz_;
    bool ended_ = false;
    std::uint64_t missed_ = 0;  ///< of the material's images
};

}  // namespace

SourceEntry files_source_entry() {
    return {.kind = "files", .takes_ideal_rig = true, .make = [](const RigConfig& config) {
                return std::make_unique<FilesSource>(config);
            }};
}

}  // namespace vantage
