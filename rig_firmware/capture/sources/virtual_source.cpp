#include "common/base/error.h"
#include "common/base/log.h"
#include "common/config/rig_config.h"
#include "common/gl/context/driver_lock.h"
#include "common/gl/context/egl_context.h"
#include "common/gl/shader_library.h"
#include "common/virtual_stage/performer.h"
#include "common/virtual_stage/virtual_rig.h"
#include "common/virtual_stage/virtual_stage.h"
#include "rig_firmware/capture/material/pulse_pacer.h"
#include "rig_firmware/capture/material/virtual_skew.h"
#include "rig_firmware/capture/pair_loop.h"
#include "rig_firmware/capture/rig_calibration.h"
#include "rig_firmware/capture/stereo_source.h"

namespace vantage {
namespace {

/// Source that films the virtual stage. Pulse k shows it at the time of pulse k since 1970 TAI, so
/// that all rigs of a stage, each in its own process, see the same moments.
class VirtualSource final : public StereoSource {
  public:
    explicit VirtualSource(const RigConfig& config)
        : calibration_(rig_calibration(config, {config.source.width_px, config.source.height_px})),
          noise_{config.source.noise_sigma, config.source.seed},
          rig_(calibration_, noise_, config.match.matcher == exact_matcher),
          scene_(config.virtual_rig.scene),
          stage_(shaders_, static_cast<std::uint64_t>(scene_)),
          pulses_(config.source.rate_hz),
          pacer_(pulses_),
          // Exact depth is rendered for every frame.
          loop_(size(), stage_loop, pulses_,
                config.match.matcher == exact_matcher
                    ? 0
                    : static_cast<std::size_t>(config.virtual_rig.loop_mb * 1e6)),
          skew_(config, size()) {
        if (config.virtual_rig.doffs_px != 0)
            fail(
                "'doffs_px' in [virtual_rig] is {}, and the virtual source films with parallel "
                "cameras only: leave it 0",
                config.virtual_rig.doffs_px);
        // Drivers finish compiling at the first draw call, which takes seconds with software
        // rendering.
        (void)rig_.render(stage_, {}, 0);
        if (config.virtual_rig.loop_ahead) film_loop(config.virtual_rig.loop_mb);
    }

    cv::Size size() const override {
        return {calibration_.left.width_px, calibration_.left.height_px};
    }

    std::optional<StereoFrame> next(std::chrono::nanoseconds timeout) override {
        const std::optional<Pulse> pulse = pacer_.wait_next(timeout);
        if (!pulse) return std::nullopt;
        VirtualStereoFrame picture = film(pulse->time.time_since_epoch());
        skew_.draw_bar(picture.left, picture.right, pulse->time);
        rig_.add_noise(picture, pulse->index);
        return StereoFrame{.trigger_index = pulse->index,
                           .synchronized = true,
                           .exposure = pulse->time,
                           .exposed = pulse->monotonic,
                           .left = std::move(picture.left),
                           .right = std::move(picture.right),
                           .exact_disparity = std::move(picture.exact_disparity)};
    }

    bool works_on_demand() const override { return true; }
    std::uint64_t missed() const override { return pacer_.missed(); }
    std::vector<SourceCounter> counters() const override {
        return {{"clock_steps", pacer_.clock_steps()}};
    }

    std::vector<std::string> report() const override {
        return {
            fmt::format("virtual stage, scene {}, two {}x{} cameras at {} Hz, noise of {} grey "
                        "levels, keeps {} "
                        "of {} pairs of its loop",
                        scene_, size().width, size().height, pulses_.rate_hz(), noise_.sigma,
                        loop_.kept(), loop_.room())};
    }

  private:
    void film_loop(double loop_mb) {
        if (loop_.length() == 0)
            fail(
                "'loop_ahead' in [virtual_rig] needs a loop that repeats, and at {} Hz that of "
                "{:g} "
                "s does not: leave it false, or take another rate_hz",
                pulses_.rate_hz(), std::chrono::duration<double>(stage_loop).count());
        if (loop_.room() < loop_.length())
            fail(
                "'loop_ahead' in [virtual_rig] asks for {} pairs of {}x{}, and {} fit into "
                "loop_mb = {:g}{}: raise it, or leave 'loop_ahead' false",
                loop_.length(), size().width, size().height, loop_.room(), loop_mb,
                loop_.room() == 0 ? " (with exact disparity none are kept)" : "");
        log_info("drawing the {} pairs of the stage's loop ahead", loop_.length());
        for (std::size_t pair = 0; pair < loop_.length(); ++pair)
            (void)film(pulses_.time_of(pair).time_since_epoch());
    }

    /// Returns the noise-free frame, from the cache or rendered.
    VirtualStereoFrame film(std::chrono::nanoseconds time) {
        VirtualStereoFrame picture;
        if (std::optional<PairLoop::Pair> known = loop_.find(time)) {
            picture.left = std::move(known->left);
            picture.right = std::move(known->right);
            return picture;
        }
        const DriverLock turn(context_.driver());
        picture = rig_.render_noiseless(stage_, time + skew_.left(), skew_.right() - skew_.left());
        loop_.keep(time, picture.left, picture.right);
        return picture;
    }

    EglContext context_;
    ShaderLibrary shaders_;
    StereoCalibration calibration_;
    SensorNoise noise_;
    VirtualRig rig_;
    int scene_;
    VirtualStage stage_;
    PulseGrid pulses_;
    PulsePacer pacer_;
    PairLoop loop_;
    VirtualSkew skew_;
};

}  // namespace

SourceEntry virtual_source_entry() {
    return {.kind = "virtual", .takes_ideal_rig = true, .make = [](const RigConfig& config) {
                return std::make_unique<VirtualSource>(config);
            }};
}

}  // namespace vantage
