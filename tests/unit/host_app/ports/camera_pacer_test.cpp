#include <mutex>
#include <vector>

#include <gtest/gtest.h>

#include "host_app/control/ports/tracking_sinks.h"
#include "tests/support/eventually.h"

namespace vantage {
namespace {

/// A rate whose ticks are not late within any test.
constexpr double slow_hz = 0.001;

class CameraPacerTest : public testing::Test {
  protected:
    void send(const CameraTick& tick) {
        const std::lock_guard lock(mutex_);
        sent_.push_back(tick);
        threads_.push_back(std::this_thread::get_id());
    }
    auto sender() {
        return [this](const CameraTick& tick) { send(tick); };
    }
    std::vector<CameraTick> sent() const {
        const std::lock_guard lock(mutex_);
        return sent_;
    }
    std::vector<std::thread::id> threads() const {
        const std::lock_guard lock(mutex_);
        return threads_;
    }
    CameraTick tick(std::uint64_t number, double rate_hz) const {
        CameraTick tick;
        tick.tick = number;
        tick.due = start_ + from_s(static_cast<double>(number) / rate_hz);
        tick.camera.focus_m = static_cast<double>(number) + 1;
        return tick;
    }

  private:
    const MonotonicTime start_ = MonotonicClock::now();
    mutable std::mutex mutex_;
    std::vector<CameraTick> sent_;
    std::vector<std::thread::id> threads_;
};

TEST_F(CameraPacerTest, SendsEveryTickOnce) {
    CameraPacer pacer(slow_hz, sender());
    pacer.take(tick(0, slow_hz));
    ASSERT_TRUE(eventually([&] { return !sent().empty(); })) << "the first tick waits for none";
    for (const std::uint64_t number : {1, 1, 2, 3}) pacer.take(tick(number, slow_hz));
    ASSERT_TRUE(eventually([&] { return sent().size() >= 4; }));
    pacer.take(tick(2, slow_hz));
    pacer.stop();
    pacer.take(tick(9, slow_hz));
    const std::vector<CameraTick> all = sent();
    ASSERT_EQ(all.size(), 4u);
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_EQ(all[i].tick, i);
        EXPECT_EQ(all[i].due, tick(i, slow_hz).due);
    }
    EXPECT_EQ(all.back().camera.focus_m, 4);
}

TEST_F(CameraPacerTest, SendsTicksThatWereHandedOverTogetherOneByOne) {
    CameraPacer pacer(slow_hz, sender());
    pacer.take(tick(3, slow_hz));
    pacer.stop();
    const std::vector<CameraTick> all = sent();
    ASSERT_EQ(all.size(), 4u);
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_EQ(all[i].tick, i);
        EXPECT_EQ(all[i].due, tick(i, slow_hz).due);
        EXPECT_EQ(all[i].camera.focus_m, 4) << "the newest camera";
    }
}

TEST_F(CameraPacerTest, NeverSendsOnTheThreadOfTheProgramme) {
    constexpr double fast_hz = 1000;
    CameraPacer pacer(fast_hz, sender());
    for (std::uint64_t number = 0; number < 100; ++number) pacer.take(tick(number, fast_hz));
    ASSERT_TRUE(eventually([&] { return sent().size() >= 105; })) << "repeated ones too";
    pacer.take(tick(1000, fast_hz));
    pacer.stop();
    const std::vector<std::thread::id> all = threads();
    for (const std::thread::id id : all) {
        EXPECT_EQ(id, all.front());
        EXPECT_NE(id, std::this_thread::get_id());
    }
}

/// A sender that stands must not hold the programme up.
TEST_F(CameraPacerTest, TakesTicksWhileOneIsBeingSent) {
    std::mutex standing;
    std::unique_lock hold(standing);
    CameraPacer pacer(slow_hz, [&](const CameraTick& tick) {
        const std::lock_guard wait(standing);
        send(tick);
    });
    for (std::uint64_t number = 0; number < 5; ++number) pacer.take(tick(number, slow_hz));
    EXPECT_TRUE(sent().empty());
    hold.unlock();
    ASSERT_TRUE(eventually([&] { return sent().size() >= 5; }));
    EXPECT_EQ(sent().back().tick, 4u);
}

TEST_F(CameraPacerTest, RepeatsTheCameraOfALateTick) {
    constexpr double rate_hz = 100;
    CameraPacer pacer(rate_hz, sender());
    pacer.take(tick(0, rate_hz));
    ASSERT_TRUE(eventually([&] { return sent().size() >= 5; })) << "nobody hands over tick 1";
    pacer.take(tick(1, rate_hz));
    pacer.stop();
    const std::vector<CameraTick> all = sent();
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_EQ(all[i].tick, i) << "no tick twice";
        EXPECT_EQ(all[i].due, tick(i, rate_hz).due);
    }
    EXPECT_EQ(all[4].camera.focus_m, 1) << "the camera of tick 0";
}

TEST_F(CameraPacerTest, EndsAfterAProgrammeThatHandsOverNothing) {
    constexpr double rate_hz = 200;
    constexpr std::size_t a_second = 201;
    CameraTick first = tick(0, rate_hz);
    first.due -= std::chrono::minutes(1);
    CameraPacer pacer(rate_hz, sender());
    pacer.take(first);
    ASSERT_TRUE(eventually([&] { return sent().size() >= a_second; })) << "a second at once";
    CameraTick last = tick(a_second, rate_hz);
    pacer.take(last);
    pacer.stop();
    ASSERT_GT(sent().size(), a_second);
    EXPECT_EQ(sent()[a_second].camera.focus_m, last.camera.focus_m) << "not repeated";
}

}  // namespace
}  // namespace vantage
