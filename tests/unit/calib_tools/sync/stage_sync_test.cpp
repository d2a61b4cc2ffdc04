#include "calib_tools/sync/stage_sync.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/base/time/time.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/calib_tools/sync/filmed_sensor.h"

namespace vantage {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

SyncRecord record_of(const std::vector<SensorFilm>& films, const SyncBar& bar) {
    SyncRecord record;
    record.rate_hz = 30;
    record.sensors = skews_of(films, bar, record.rate_hz);
    record.reference = record.sensors.front().name();
    return record;
}

/// Skews of 0 to 20 ms at one exposure, each of another sensor with noise of its own.
class Skews : public testing::TestWithParam<int> {};

TEST_P(Skews, are_found_to_a_tenth_of_a_millisecond) {
    const SyncBar bar(12, microseconds(127));
    const microseconds exposure(GetParam());
    std::vector<SensorFilm> films;
    const std::vector<int> skews_us = {0, 30, -700, 8470, 20000};
    for (const int skew_us : skews_us) {
        const FilmedSensor sensor{
            .skew = microseconds(skew_us), .exposure = exposure, .seed = films.size() + 1};
        films.push_back(sensor.film(bar, fmt::format("R{}", films.size()), true));
        EXPECT_NEAR(films.back().seen.fit.length_ms, to_ms(exposure), 0.1);
        EXPECT_EQ(films.back().seen.transfer, "sRGB");
    }
    const std::vector<SensorSkew> found = skews_of(films, bar, 30);
    for (std::size_t i = 1; i < found.size(); ++i) {
        const double miss_ms = found[i].skew_ms - 1e-3 * skews_us[i];
        EXPECT_LT(std::abs(miss_ms), 0.1);
        EXPECT_LT(std::abs(miss_ms), 5 * found[i].sigma_ms + 0.005);
        EXPECT_LT(found[i].sigma_ms, 0.05);
        EXPECT_EQ(found[i].strays, 0);
    }
}

INSTANTIATE_TEST_SUITE_P(at_exposures, Skews, testing::Values(2000, 3100, 5000, 8000));

TEST(StageSync, compares_the_centres_of_different_exposures) {
    const SyncBar bar(12, microseconds(127));
    const std::vector<SensorFilm> films = {
        FilmedSensor{.exposure = microseconds(2000)}.film(bar, "A", true),
        FilmedSensor{.exposure = microseconds(6000), .seed = 2}.film(bar, "A", false)};
    const SyncRecord record = record_of(films, bar);
    EXPECT_NEAR(record.sensors[1].skew_ms, 2.0, 0.05);
    EXPECT_THAT(sync_troubles(record, 0.5), ElementsAre(HasSubstr("A right exposes 2.0")));
}

TEST(StageSync, names_pairs_and_rigs_that_are_a_frame_apart) {
    const SyncBar bar(12, microseconds(127));
    const auto film = [&](const char* rig, bool is_left, int skew_us, std::uint64_t seed) {
        return FilmedSensor{.skew = microseconds(skew_us), .seed = seed}.film(bar, rig, is_left);
    };
    const std::vector<SensorFilm> films = {
        film("A", true, 0, 1),        film("A", false, 40, 2), film("B", true, -33'333, 3),
        film("B", false, -33'300, 4), film("C", true, 100, 5), film("C", false, 33'400, 6)};
    const SyncRecord record = record_of(films, bar);
    EXPECT_NEAR(record.worst_ms(), 66.733, 0.05);
    EXPECT_EQ(record.sensors[2].pulses_apart, -1);
    EXPECT_EQ(record.sensors[3].pulses_apart, -1);
    EXPECT_EQ(record.sensors[5].pulses_apart, 1);
    EXPECT_THAT(sync_troubles(record, 0.5),
                ElementsAre(HasSubstr("C right is 1 frame behind (+33."),
                            HasSubstr("B left is 1 frame ahead of (-33.")));
    EXPECT_THAT(sync_doubts(record, 0.5), IsEmpty());
}

TEST(StageSync, counts_pictures_that_are_of_another_pulse_than_they_say) {
    const SyncBar bar(12, microseconds(127));
    const FilmedSensor sensor;
    BarFilm stray = sensor.film_of(bar);
    for (const std::size_t i : {3, 11})
        stray.pictures[i] = sensor.picture(bar, stray.pulses[i], microseconds(33'333));
    const std::vector<SensorFilm> films = {sensor.film(bar, "A", true),
                                           {"A", false, sensor.pulses(), read_bar(stray, bar, 30)}};
    const SyncRecord record = record_of(films, bar);
    EXPECT_EQ(record.sensors[1].strays, 2);
    EXPECT_NEAR(record.sensors[1].skew_ms, 0, 0.05);
    EXPECT_THAT(sync_troubles(record, 0.5),
                ElementsAre(HasSubstr("A right was elsewhere in 2 of 24 pictures")));
}

TEST(StageSync, finds_a_bar_that_hangs_askew_or_upside_down) {
    const SyncBar bar(12, microseconds(127));
    const FilmedSensor straight;
    FilmedSensor upside_down{.skew = microseconds(1500), .seed = 2};
    upside_down.place = {.first_px = {290, 60}, .last_px = {230, 15}, .led_radius_px = 1.5};
    FilmedSensor upright{.skew = microseconds(-2500), .seed = 3};
    upright.place = {.first_px = {250, 20}, .last_px = {262, 225}, .led_radius_px = 4};
    const std::vector<SensorSkew> found =
        skews_of({straight.film(bar, "A", true), upside_down.film(bar, "B", true),
                  upright.film(bar, "C", true)},
                 bar, 30);
    EXPECT_NEAR(found[1].skew_ms, 1.5, 0.1);
    EXPECT_NEAR(found[2].skew_ms, -2.5, 0.1);
}

TEST(StageSync, reads_a_small_and_blurred_bar) {
    const SyncBar bar(12, microseconds(127));
    FilmedSensor far{.skew = microseconds(4321), .seed = 2};
    far.place = {.first_px = {60, 50}, .last_px = {104, 53}, .led_radius_px = 1.2};
    BarFilm film = far.film_of(bar);
    for (GreyImage& picture : film.pictures) cv::GaussianBlur(picture, picture, {}, 0.8);
    const std::vector<SensorSkew> found = skews_of(
        {FilmedSensor{}.film(bar, "A", true), {"B", true, film.pulses, read_bar(film, bar, 30)}},
        bar, 30);
    EXPECT_NEAR(found[1].skew_ms, 4.321, 0.1);
}

TEST(StageSync, leaves_out_pictures_in_which_somebody_stands_before_the_bar) {
    const SyncBar bar(12, microseconds(127));
    const FilmedSensor free, hidden{.skew = microseconds(700), .seed = 2};
    BarFilm film = hidden.film_of(bar);
    for (const std::size_t i : {2, 9, 10})
        film.pictures[i](cv::Rect(200, 0, 90, 240)).setTo(cv::Scalar(120));
    const SensorExposures seen = read_bar(film, bar, 30);
    EXPECT_LE(seen.fit.used, 21);
    EXPECT_GE(seen.fit.used, 18);
    const std::vector<SensorSkew> found =
        skews_of({free.film(bar, "A", true), {"A", false, hidden.pulses(), seen}}, bar, 30);
    EXPECT_NEAR(found[1].skew_ms, 0.7, 0.1);
}

TEST(StageSync, knows_no_more_than_a_screen_shows) {
    // A screen at 60 Hz, whose steps beat with pulses at 25 Hz.
    const SyncBar screen(8, microseconds(16'667));
    const auto film = [&](const char* name, int skew_us, std::uint64_t seed) {
        FilmedSensor sensor{
            .skew = microseconds(skew_us), .seed = seed, .count = 40, .rate_hz = 25};
        sensor.place = BarPlace::across({320, 240}, 8);
        return sensor.film(screen, name, true);
    };
    const std::vector<SensorSkew> found =
        skews_of({film("A", 0, 1), film("B", 40'000, 2)}, screen, 25);
    EXPECT_NEAR(found[1].skew_ms, 40, 17);
    EXPECT_EQ(found[1].pulses_apart, 1);
}

TEST(StageSync, does_not_trust_steps_that_divide_the_time_between_pictures) {
    const SyncBar bar(12, microseconds(100));
    const auto film = [&](const char* name, int skew_us, std::uint64_t seed) {
        FilmedSensor sensor{.skew = microseconds(skew_us), .exposure = microseconds(3100)};
        sensor.seed = seed;
        sensor.rate_hz = 25;
        return sensor.film(bar, name, true);
    };
    SyncRecord record;
    record.sensors = skews_of({film("A", 0, 1), film("B", 3438, 2)}, bar, 25);
    record.reference = "A left";
    EXPECT_GT(record.sensors[1].sigma_ms, 1.5);
    EXPECT_NEAR(record.sensors[1].skew_ms, 3.438, 2 * record.sensors[1].sigma_ms);
    EXPECT_THAT(sync_doubts(record, 0.5), Contains(HasSubstr("B left is known to")));
}

/// What is said of these pictures of a bar of 12 LEDs and steps of 0.127 ms.
std::string refusal(const FilmedSensor& sensor) {
    const SyncBar bar(12, microseconds(127));
    return thrown_sentence([&] { read_bar(sensor.film_of(bar), bar, 30); });
}

TEST(StageSync, says_why_a_film_tells_nothing) {
    EXPECT_EQ(refusal({.count = 7}),
              "A left: 7 pictures are too few, 8 are needed and 20 are good");
    EXPECT_THAT(refusal({.has_bar = false}),
                HasSubstr("A left: no bar of 12 LEDs that counts steps of 0.127 ms is seen in 24 "
                          "pictures"));
    EXPECT_THAT(refusal({.exposure = microseconds(600'000)}),
                HasSubstr("an exposure near the bar's period of 520.2 ms or longer"));
    FilmedSensor clipped;
    clipped.place.led_light = 4;
    EXPECT_THAT(refusal(clipped), HasSubstr("A left: the bar's LEDs are clipped"));
}

TEST(StageSync, needs_pictures_of_the_same_pulses) {
    const SyncBar bar(12, microseconds(127));
    SensorFilm film = FilmedSensor{}.film(bar, "A", true), other = film;
    other.is_left = false;
    for (std::size_t i = 0; i < other.pulses.size(); ++i)
        if (i >= 5) ++other.pulses[i];
    EXPECT_THAT(thrown_sentence([&] {
                    skews_of({film, other}, bar, 30);
                }),
                HasSubstr("A right: only 5 of its pictures are of pulses of which A left has a "
                          "picture too"));
}

}  // namespace
}  // namespace vantage
