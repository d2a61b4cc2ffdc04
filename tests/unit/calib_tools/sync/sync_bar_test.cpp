#include "common/sync/sync_bar.h"

#include <bit>

#include <gtest/gtest.h>

#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using std::chrono::microseconds;
using std::chrono::nanoseconds;

TEST(SyncBar, changes_one_led_at_every_step_and_says_the_step_of_what_is_lit) {
    const SyncBar bar(8, microseconds(100));
    EXPECT_EQ(bar.period(), microseconds(25600));
    for (std::uint32_t step = 0; step < 256; ++step) {
        EXPECT_EQ(SyncBar::step_of(SyncBar::lit_in(step)), step);
        EXPECT_EQ(std::popcount(SyncBar::lit_in(step) ^ SyncBar::lit_in((step + 1) % 256)), 1);
        EXPECT_EQ(bar.step_at(tai_from_ns(1'000'000'000LL * 25'600 + step * 100'000 + 99'999)),
                  step);
    }
}

TEST(SyncBar, says_the_share_of_an_exposure_in_which_an_led_is_lit) {
    const SyncBar bar(7, microseconds(100));
    for (int led = 0; led < bar.leds(); ++led)
        for (const int begin_us : {0, 40, 333, 5000, 12'790})
            for (const int length_us : {30, 250, 2000, 13'000}) {
                int lit = 0;
                for (int us = begin_us; us < begin_us + length_us; ++us) {
                    const TaiTime time = tai_from_ns(1000LL * us);
                    lit += static_cast<int>(SyncBar::lit_in(bar.step_at(time)) >> led & 1);
                }
                EXPECT_NEAR(bar.lit_share(led, 1e3 * begin_us, 1e3 * length_us),
                            static_cast<double>(lit) / length_us, 1e-9)
                    << led << ' ' << begin_us << ' ' << length_us;
            }
}

TEST(SyncBar, refuses_what_no_bar_is) {
    EXPECT_EQ(thrown_sentence([] { SyncBar(4, microseconds(100)); }),
              "a bar has 5 to 20 LEDs, not 4");
    EXPECT_EQ(thrown_sentence([] { SyncBar(12, nanoseconds(5000)); }),
              "a bar's step is 10 to 1000000 us, not 5");
}

}  // namespace
}  // namespace vantage
