#include "host_app/control/ports/camera_pacer.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/support/eventually.h"

namespace vantage {
namespace {

class CameraPacerTest : public testing::Test {
  protected:
    void send(const CameraTick& tick) {
        const std::lock_guard lock(mutex_);
        sent_.push_back(tick);
    }
    std::vector<CameraTick> sent() const {
        const std::lock_guard lock(mutex_);
        return sent_;
    }
    static ProgrammePicture picture(std::uint64_t tick) {
        ProgrammePicture picture;
        picture.tick = tick;
        picture.picture = ColourImage(72, 128);
        picture.camera.focus_m = static_cast<double>(tick) + 1;
        return picture;
    }

  private:
    mutable std::mutex mutex_;
    std::vector<CameraTick> sent_;
};

TEST_F(CameraPacerTest, SendsEveryTickOnce) {
    constexpr double slow_hz = 0.01;
    CameraPacer pacer(slow_hz, [this](const CameraTick& tick) { send(tick); });
    pacer.take(picture(5));
    ASSERT_EQ(sent().size(), 1u) << "at once";
    EXPECT_EQ(sent()[0].camera.focus_m, 6);
    EXPECT_EQ(sent()[0].width_px, 128);
    for (const std::uint64_t tick : {6, 6, 7, 8}) pacer.take(picture(tick));
    ASSERT_TRUE(eventually([&] { return sent().size() >= 4; }));
    pacer.take(picture(7));
    pacer.stop();
    pacer.take(picture(9));
    const std::vector<CameraTick> all = sent();
    ASSERT_EQ(all.size(), 4u);
    for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i].tick, 5 + i);
    EXPECT_EQ(all.back().camera.focus_m, 9);
}

TEST_F(CameraPacerTest, RepeatsTheCameraOfALateTick) {
    CameraPacer pacer(100, [this](const CameraTick& tick) { send(tick); });
    pacer.take(picture(0));
    pacer.take(picture(1));
    ASSERT_TRUE(eventually([&] { return sent().size() >= 5; })) << "nobody hands over tick 2";
    pacer.take(picture(2));
    pacer.stop();
    const std::vector<CameraTick> all = sent();
    for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i].tick, i) << "no tick twice";
    EXPECT_EQ(all[4].camera.focus_m, 2) << "the camera of tick 1";
}

TEST_F(CameraPacerTest, EndsAfterAProgrammeThatHandsOverNothing) {
    CameraPacer pacer(200, [this](const CameraTick& tick) { send(tick); });
    pacer.take(picture(0));
    pacer.take(picture(1));
    std::size_t before = 0;
    const auto stands = [&] {
        const std::size_t last = std::exchange(before, sent().size());
        return last == before && before > 2;
    };
    ASSERT_TRUE(eventually(stands, longest_wait, std::chrono::milliseconds(400)));
    EXPECT_GT(before, 100u);
    EXPECT_LT(before, 250u);
}

}  // namespace
}  // namespace vantage
