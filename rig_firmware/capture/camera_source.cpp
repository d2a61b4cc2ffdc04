#include "rig_firmware/capture/camera_source.h"

#include <algorithm>
#include <array>
#include <thread>
#include <utility>

#include <poll.h>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/time/clock_step_watch.h"
#include "common/config/rig_config.h"
#include "rig_firmware/capture/device_lost.h"
#include "rig_firmware/capture/frame_pairer.h"
#include "rig_firmware/capture/material/stereo_material.h"
#include "rig_firmware/capture/pulse_numberer.h"
#include "rig_firmware/capture/sequence_gaps.h"
#include "rig_firmware/clock/clock_model.h"
#include "rig_firmware/clock/clock_pair.h"
#include "rig_firmware/trigger/rig_trigger.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr std::chrono::nanoseconds time_between_reopenings = 500ms;
constexpr std::chrono::nanoseconds longest_silence = 3s;

/// Detects cameras that should deliver frames but are silent. Triggered cameras owe a frame only
/// from the first pulse after their last frame: before the show they may wait for hours.
class Silence {
  public:
    /// `period` is the frame period; slow cameras may take three periods.
    explicit Silence(std::chrono::nanoseconds period)
        : longest_(std::max(longest_silence, 3 * period)) {}

    void heard() {
        since_ = MonotonicClock::now();
        is_answered_ = true;
    }
    bool is_too_long(const RigTrigger* trigger) {
        const MonotonicTime now = MonotonicClock::now();
        if (trigger) {
            const std::uint64_t pulses = trigger->pulses();
            if (std::exchange(is_answered_, false)) answered_pulses_ = pulses;
            if (pulses == answered_pulses_) since_ = now;
        }
        return now - since_ > longest_;
    }
    std::chrono::nanoseconds longest() const { return longest_; }

  private:
    std::chrono::nanoseconds longest_;
    MonotonicTime since_{};
    std::uint64_t answered_pulses_ = 0;
    bool is_answered_ = false;
};

/// Source of two cameras, or of one camera that delivers both images side by side. It pairs frames
/// by the kernel's time stamps. Triggered cameras get the index of the pulse that exposed them;
/// free-running cameras get that of the nearest pulse. A camera that is unplugged or silent is
/// reopened until it is back.
class CameraSource final : public StereoSource {
  public:
    CameraSource(const RigConfig& config, CameraOpener opener)
        : config_(config.source),
          opener_(std::move(opener)),
          grid_(config.source.rate_hz),
          numberer_(grid_),
          pairer_(grid_.period()),
          silence_(grid_.period()) {
        if (config_.left_device.empty())
            fail("the source '{}' needs a camera: name it with 'left_device' in [source]",
                 config_.kind);
        if (config_.left_device == config_.right_device)
            fail(
                "'left_device' and 'right_device' are both {}: name two cameras, or leave "
                "'right_device' out and say side_by_side = true for one that delivers both "
                "pictures side by side",
                config_.left_device);
        open();
        for (const auto& camera : cameras_)
            for (std::string& line : camera->report()) report_.push_back(std::move(line));
        if (config.trigger.role == "free")
            report_.push_back(
                "the cameras are not triggered: pictures are joined by their time stamps, and "
                "their pulse index is the nearest one");
    }

    void use(RigTrigger* trigger) override { trigger_ = trigger; }

    std::vector<LentPicture> specimens() const override {
        std::vector<LentPicture> specimens;
        for (const auto& camera : cameras_) {
            std::optional<LentPicture> specimen = camera->specimen();
            if (!specimen) return {};
            specimens.push_back(std::move(*specimen));
        }
        if (specimens.size() == 1) {
            specimens.push_back(specimens[0]);
            halve(specimens[0].view, specimens[1].view);
        }
        return specimens;
    }

    void lend() override {
        lends_ = true;
        for (const auto& camera : cameras_) camera->lend();
    }

    cv::Size size() const override { return {config_.width_px, config_.height_px}; }

    std::optional<StereoFrame> next(std::chrono::nanoseconds timeout) override {
        const MonotonicTime deadline = MonotonicClock::now() + timeout;
        do {
            try {
                if (cameras_.empty()) open();
                if (!begun_) drain();
                if (std::optional<StereoFrame> frame = take_frame(deadline)) return frame;
                if (silence_.is_too_long(trigger_))
                    throw DeviceLost(
                        fmt::format("the cameras gave no pair of pictures for {} s",
                                    std::chrono::duration<double>(silence_.longest()).count()));
            } catch (const Error& error) {
                lose(error.what());
                std::this_thread::sleep_until(
                    std::chrono::steady_clock::now() +
                    std::min(time_between_reopenings, deadline - MonotonicClock::now()));
            }
        } while (MonotonicClock::now() < deadline);
        return std::nullopt;
    }

    std::uint64_t missed() const override {
        return trigger_ ? trigger_->missed() : numberer_.missed();
    }

    std::optional<ClockModel::State> clock() const override {
        if (!clocks_.ready()) return std::nullopt;
        return clocks_.state();
    }

    std::vector<SourceCounter> counters() const override {
        std::uint64_t damaged = damaged_before_;
        for (const auto& camera : cameras_) damaged += camera->damaged();
        return {{"left_sequence_gaps", gaps_[0].lost()},
                {"right_sequence_gaps", gaps_[1].lost()},
                {"unpaired", pairer_.unpaired()},
                {"surplus", numberer_.surplus()},
                {"damaged", damaged},
                {"reopened", reopened_},
                {copied_pictures, copied_},
                {"clock_steps", clocks_.state().steps}};
    }

    std::vector<std::string> report() const override { return report_; }

  private:
    struct Joined {
        MonotonicTime time{};
        SensorPicture left, right;
    };

    void open() {
        std::vector<std::unique_ptr<SensorCamera>> cameras;
        const bool side_by_side = config_.right_device.empty();
        cameras.push_back(opener_(config_.left_device, side_by_side));
        if (!side_by_side) cameras.push_back(opener_(config_.right_device, false));
        cameras_ = std::move(cameras);
        if (lends_) lend();
        silence_.heard();
        if (lost_because_.empty()) return;
        ++reopened_;
        lost_because_.clear();
        log_info("the cameras deliver again");
    }

    /// Discards the frames that the drivers captured while the rest of the daemon started. They are
    /// old, and many frames are missing after them. Stops at the first new frame, since a computer
    /// that converts frames more slowly than they arrive would never reach the last one.
    void drain() {
        const MonotonicTime begin = MonotonicClock::now();
        for (const auto& camera : cameras_)
            for (;;) {
                const std::optional<SensorPicture> picture = camera->take();
                if (!picture || picture->time >= begin) break;
            }
        silence_.heard();
        begun_ = true;
    }

    void lose(const std::string& why) {
        for (const auto& camera : cameras_) damaged_before_ += camera->damaged();
        cameras_.clear();
        pairer_.clear();
        for (SequenceGaps& gaps : gaps_) gaps.restart();
        if (why != lost_because_)
            log_warning("{}; frames are missed until the cameras deliver again", why);
        lost_because_ = why;
    }

    std::optional<StereoFrame> take_frame(MonotonicTime deadline) {
        std::optional<Joined> joined = take_joined();
        if (!joined) {
            wait_for_picture(deadline);
            joined = take_joined();
        }
        if (!joined) return std::nullopt;
        silence_.heard();
        return frame_of(std::move(*joined));
    }

    std::optional<StereoFrame> frame_of(Joined joined) {
        read_clocks();
        const TaiTime stamp = clocks_.to_tai(joined.time);
        StereoFrame frame;
        frame.exposed = joined.time;
        frame.left = std::move(joined.left.colour);
        frame.right = std::move(joined.right.colour);
        frame.lent_left = std::move(joined.left.lent);
        frame.lent_right = std::move(joined.right.lent);
        if (trigger_) {
            const std::optional<std::uint64_t> index = trigger_->index_of(stamp);
            frame.synchronized = index.has_value();
            frame.exposure = trigger_->exposure_centre(stamp);
            // A frame without a pulse gets the index of the pulse before it, so that it never takes
            // the index of a later frame.
            frame.trigger_index = index.value_or(grid_.index_at_or_before(frame.exposure));
            return frame;
        }
        const std::optional<std::uint64_t> index = numberer_.number(stamp);
        if (!index) return std::nullopt;
        frame.trigger_index = *index;
        frame.exposure = stamp;
        return frame;
    }

    /// Reads both clocks every quarter of a second, which keeps the model current at no cost. A
    /// clock that was set counts from the next frame on.
    void read_clocks() {
        constexpr std::chrono::milliseconds between(250);
        const MonotonicTime now = MonotonicClock::now();
        const ClockPair pair = ClockPair::now();
        if (steps_.observe(pair.monotonic, pair.tai)) {
            clocks_.restart(pair.monotonic, pair.tai);
            clocks_read_ = now;
            numberer_.clock_was_set();
            if (trigger_) trigger_->clock_was_set();
            return;
        }
        if (clocks_.ready() && now - clocks_read_ < between) return;
        clocks_.observe(pair.monotonic, pair.tai);
        clocks_read_ = now;
    }

    void wait_for_picture(MonotonicTime deadline) const {
        std::array<pollfd, 2> waits{};
        for (std::size_t i = 0; i < cameras_.size(); ++i)
            waits[i] = {.fd = cameras_[i]->fd(), .events = POLLIN, .revents = 0};
        const auto left =
            std::chrono::ceil<std::chrono::milliseconds>(deadline - MonotonicClock::now());
        ::poll(waits.data(), cameras_.size(),
               static_cast<int>(std::max<std::int64_t>(left.count(), 0)));
    }

    std::optional<Joined> take_joined() {
        if (cameras_.size() == 1) {
            std::optional<SensorPicture> both = take(0);
            if (!both) return std::nullopt;
            return split(*both);
        }
        if (auto left = take(0)) pairer_.push_left(left->time, std::move(*left));
        if (auto right = take(1)) pairer_.push_right(right->time, std::move(*right));
        auto pair = pairer_.pop();
        if (!pair) return std::nullopt;
        return Joined{pair->left.time + (pair->right.time - pair->left.time) / 2,
                      std::move(pair->left.picture), std::move(pair->right.picture)};
    }

    /// Splits one side-by-side image into its halves.
    Joined split(const SensorPicture& both) const {
        Joined joined{both.time, both, both};
        if (both.lent) {
            halve(joined.left.lent->view, joined.right.lent->view);
            return joined;
        }
        StereoPair pair = split_side_by_side(both.colour, config_.left_device);
        joined.left.colour = std::move(pair.left);
        joined.right.colour = std::move(pair.right);
        return joined;
    }
    static void halve(cv::Rect& left, cv::Rect& right) {
        left.width /= 2;
        right.width = left.width;
        right.x = left.x + left.width;
    }

    std::optional<SensorPicture> take(std::size_t side) {
        std::optional<SensorPicture> picture = cameras_[side]->take();
        if (!picture) return std::nullopt;
        gaps_[side].see(picture->sequence);
        if (!picture->lent) ++copied_;
        return picture;
    }

    RigConfig::Source config_;
    CameraOpener opener_;
    PulseGrid grid_;
    RigTrigger* trigger_ = nullptr;
    ClockModel clocks_;
    ClockStepWatch steps_;
    MonotonicTime clocks_read_{};
    PulseNumberer numberer_;
    FramePairer<SensorPicture> pairer_;
    std::vector<std::unique_ptr<SensorCamera>>
        cameras_;  ///< left, right, or one with both sides; null: lost
    std::array<SequenceGaps, 2> gaps_;
    bool begun_ = false;
    bool lends_ = false;
    Silence silence_;  ///< of both cameras
    std::string lost_because_;
    std::uint64_t reopened_ = 0, damaged_before_ = 0, copied_ = 0;
    std::vector<std::string> report_;
};

}  // namespace

std::unique_ptr<StereoSource> make_camera_source(const RigConfig& config, CameraOpener open) {
    return std::make_unique<CameraSource>(config, std::move(open));
}

}  // namespace vantage
