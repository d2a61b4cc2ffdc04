#include "rig_firmware/capture/camera_source.h"

#include <deque>
#include <memory>

#include <gtest/gtest.h>

#include "rig_firmware/capture/device_lost.h"
#include "rig_firmware/trigger/rig_trigger.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr int asked_width = 30, asked_height = 20;

/// What two cameras of a test have to deliver, and how often they were opened.
struct Bench {
    std::deque<SensorPicture> pictures;  ///< of both sides in one
    bool has_always_one = false;         ///< exposed just now
    int openings = 0;

    void deliver() {
        pictures.push_back(
            {.sequence = 0,
             .time = MonotonicClock::now(),
             .colour = ColourImage(asked_height, 2 * asked_width, cv::Vec4b::all(9))});
    }
};

class FakeCamera final : public SensorCamera {
  public:
    explicit FakeCamera(Bench& bench) : bench_(bench) { ++bench_.openings; }
    int fd() const override { return -1; }
    std::optional<SensorPicture> take() override {
        if (bench_.has_always_one) bench_.deliver();
        if (bench_.pictures.empty()) return std::nullopt;
        SensorPicture picture = std::move(bench_.pictures.front());
        bench_.pictures.pop_front();
        return picture;
    }
    std::optional<LentPicture> specimen() const override { return std::nullopt; }
    void lend() override {}
    std::uint64_t damaged() const override { return 0; }
    std::vector<std::string> report() const override { return {}; }

  private:
    Bench& bench_;
};

/// Has sent as many pulses as the test says.
class FakeTrigger final : public RigTrigger {
  public:
    void clock_was_set() override {}
    void announce(std::uint64_t) override {}
    std::optional<std::uint64_t> index_of(TaiTime) override { return 7; }
    std::uint64_t pulses() const override { return sent; }
    std::uint64_t missed() const override { return 0; }
    TaiTime exposure_centre(TaiTime stamp) const override { return stamp; }
    TriggerStatus status() const override { return {}; }
    void rethrow_failure() const override {}
    std::vector<std::string> report() const override { return {}; }

    std::uint64_t sent = 0;
};

class CameraSourceTest : public testing::Test {
  protected:
    CameraSourceTest() {
        open();
        // What lay there before the first look is thrown away.
        (void)source_->next(1ms);
    }

    void open() {
        RigConfig config;
        config.source.side_by_side = true;
        config.source.kind = "v4l2";
        config.source.left_device = "both";
        config.source.width_px = asked_width;
        config.source.height_px = asked_height;
        config.trigger.role = "lead";
        source_ = make_camera_source(config, [this](const std::string&, bool) {
            return std::make_unique<FakeCamera>(bench_);
        });
        source_->use(&trigger_);
    }

    static constexpr auto longer_than_any_silence = 3300ms;
    Bench bench_;
    FakeTrigger trigger_;
    std::unique_ptr<StereoSource> source_;
};

TEST_F(CameraSourceTest, LeavesCamerasOpenThatWaitForTheFirstPulse) {
    EXPECT_FALSE(source_->next(longer_than_any_silence));
    EXPECT_EQ(bench_.openings, 1);
    trigger_.sent = 1;
    bench_.deliver();
    const auto frame = source_->next(1s);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->trigger_index, 7u);
    EXPECT_FALSE(source_->next(longer_than_any_silence)) << "the take has ended";
    EXPECT_EQ(bench_.openings, 1);
}

TEST_F(CameraSourceTest, BeginsWithCamerasThatAreFasterThanTheirPicturesAreConverted) {
    open();
    bench_.has_always_one = true;
    EXPECT_TRUE(source_->next(1s));
}

TEST_F(CameraSourceTest, OpensCamerasAnewThatDoNotAnswerToPulses) {
    trigger_.sent = 1;
    EXPECT_FALSE(source_->next(longer_than_any_silence));
    EXPECT_FALSE(source_->next(600ms));
    EXPECT_EQ(bench_.openings, 2);
}

}  // namespace
}  // namespace vantage
