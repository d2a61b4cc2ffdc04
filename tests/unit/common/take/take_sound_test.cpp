#include <numbers>

#include <gtest/gtest.h>

#include "common/base/time/pulse_grid.h"
#include "common/take/take_check.h"
#include "common/take/take_edit.h"
#include "common/take/take_recorder.h"
#include "tests/support/data_folder.h"
#include "tests/support/source_folder.h"
#include "tests/unit/common/take/small_take.h"

namespace vantage {
namespace {

constexpr std::uint64_t heard_pulse = 1'000'000;
constexpr double take_rate_hz = 25;

std::int64_t sound_of_pulse(std::uint64_t pulse) {
    return sound_sample_at(PulseGrid(take_rate_hz).time_of(pulse));
}

/// A tone, which is another at every sample.
std::vector<float> tone(std::int64_t first, std::int64_t count) {
    std::vector<float> samples;
    for (std::int64_t i = first; i < first + count; ++i) {
        const auto time_s = static_cast<double>(i % sound_rate_hz) / sound_rate_hz;
        samples.push_back(static_cast<float>(0.5 * std::sin(2 * std::numbers::pi * 441 * time_s)));
        samples.push_back(static_cast<float>(0.5 * std::cos(2 * std::numbers::pi * 89 * time_s)));
    }
    return samples;
}

class TakeSoundTest : public testing::Test {
  protected:
    std::filesystem::path at(const std::string& name) const { return folder_.path() / name; }

    /// Of pulses from `first` to `last`; sound in blocks as it is heard, but for a gap. Its
    /// programme begins at `first_tick`, if it has one.
    void write_take(const std::string& name, std::uint64_t first, std::uint64_t last,
                    std::int64_t gap_from = 0, std::int64_t gap_to = 0,
                    std::optional<std::uint64_t> first_tick = {}) const {
        TakeFacts facts = small_facts({"left"}, first);
        facts.has_sound = true;
        TakeWriter writer(at(name), facts);
        FrameStorer storer(writer.facts().rigs[0]);
        std::int64_t heard = sound_of_pulse(first) - 700;
        for (std::uint64_t pulse = first; pulse <= last; ++pulse) {
            writer.add(0, storer.store(sent_frame("left", pulse)));
            if (first_tick && pulse >= *first_tick)
                writer.add(CameraRecord{.tick = pulse - *first_tick,
                                        .pulse = pulse,
                                        .time = PulseGrid(take_rate_hz).time_of(pulse)});
            for (; heard < sound_of_pulse(pulse + 1); heard += 4800)
                if (heard + 4800 <= gap_from || heard >= gap_to)
                    writer.add(SoundBlock{heard, tone(heard, 4800)});
        }
        writer.finish();
    }
    static void expect_tone(const TakeReader& take) {
        for (const TakeReader::Sound& sound : take.sounds()) {
            const std::vector<float> samples = sound_from_stored(take.load(sound));
            const std::vector<float> heard = tone(sound.first, sound.count);
            ASSERT_EQ(samples.size(), heard.size());
            for (std::size_t i = 0; i < heard.size(); ++i)
                ASSERT_NEAR(samples[i], heard[i], 1.0 / (1 << 23)) << sound.first + i / 2;
        }
    }
    static std::vector<std::byte> all_of(const TakeReader& take) {
        std::vector<std::byte> all;
        for (const TakeReader::Sound& sound : take.sounds()) {
            const std::vector<std::byte> bytes = take.load(sound);
            all.insert(all.end(), bytes.begin(), bytes.end());
        }
        return all;
    }
    TemporaryFolder folder_;
};

TEST_F(TakeSoundTest, IsKeptToTheBitWithTheTimeAtWhichItWasHeard) {
    write_take("take.mkv", heard_pulse, heard_pulse + 99);
    const TakeReader take(at("take.mkv"));
    ASSERT_TRUE(take.facts().has_sound);
    ASSERT_FALSE(take.sounds().empty());
    EXPECT_EQ(take.sounds().front().first, sound_of_pulse(heard_pulse))
        << "none is before the take";
    for (std::size_t i = 1; i < take.sounds().size(); ++i)
        EXPECT_EQ(take.sounds()[i].first, take.sounds()[i - 1].end());
    expect_tone(take);
    const TakeVerdict verdict = check_take(take);
    EXPECT_TRUE(verdict.is_whole());
    EXPECT_NEAR(verdict.sound_s, 4, 0.2);
}

TEST_F(TakeSoundTest, ATakeWithoutSoundIsOfVersion1AsBefore) {
    write_small_take(at("silent.mkv"), {"left"}, heard_pulse, heard_pulse + 5);
    const TakeReader silent(at("silent.mkv"));
    EXPECT_FALSE(silent.facts().has_sound);
    EXPECT_EQ(to_json(silent.facts())["vantage_take"], 1);
    const TakeReader old(source_folder() / "tests" / "takes" / "version_1.mkv");
    EXPECT_FALSE(old.facts().has_sound);
    EXPECT_TRUE(old.sounds().empty());
    write_take("take.mkv", heard_pulse, heard_pulse + 5);
    EXPECT_EQ(to_json(TakeReader(at("take.mkv")).facts())["vantage_take"], 2);
}

TEST_F(TakeSoundTest, IsCutToTheSampleAndJoinedAgain) {
    write_take("take.mkv", heard_pulse, heard_pulse + 99);
    const TakeReader take(at("take.mkv"));
    const std::uint64_t middle = heard_pulse + 37;
    EXPECT_GT(copy_takes({&take}, 0, middle, at("a.mkv")).sound_s, 1);
    copy_takes({&take}, middle, ~std::uint64_t{0}, at("b.mkv"));
    const TakeReader a(at("a.mkv")), b(at("b.mkv"));
    EXPECT_EQ(a.sounds().back().end(), sound_of_pulse(middle));
    EXPECT_EQ(b.sounds().front().first, sound_of_pulse(middle));
    expect_tone(a);
    expect_tone(b);
    copy_takes({&a, &b, &take}, 0, ~std::uint64_t{0}, at("joined.mkv"));
    const TakeReader joined(at("joined.mkv"));
    EXPECT_TRUE(check_take(joined).is_whole());
    std::vector<std::byte> whole = all_of(take);
    whole.resize(std::min(whole.size(), all_of(joined).size()));
    EXPECT_EQ(all_of(joined), whole);
}

TEST_F(TakeSoundTest, LacksNothingBeforeTheProgrammesFirstPicture) {
    const std::int64_t begin = sound_of_pulse(heard_pulse);
    const std::int64_t heard = begin + 3 * sound_rate_hz / 2;
    const auto gaps = [&](std::optional<std::uint64_t> first_tick) {
        write_take("late.mkv", heard_pulse, heard_pulse + 99, begin - sound_rate_hz, heard,
                   first_tick);
        const std::size_t count = check_take(TakeReader(at("late.mkv"))).sound_gaps.size();
        std::filesystem::remove(at("late.mkv"));
        return count;
    };
    EXPECT_EQ(gaps({}), 1u) << "half a second more than may be";
    EXPECT_EQ(gaps(heard_pulse), 1u);
    EXPECT_EQ(gaps(heard_pulse + 30), 0u) << "1.2 s after the take's begin";
}

TEST_F(TakeSoundTest, ItsGapsAndItsDamageAreNamed) {
    const std::int64_t middle = sound_of_pulse(heard_pulse + 50);
    write_take("gap.mkv", heard_pulse, heard_pulse + 99, middle, middle + 9600);
    const TakeVerdict gaps = check_take(TakeReader(at("gap.mkv")));
    EXPECT_FALSE(gaps.is_whole());
    ASSERT_EQ(gaps.sound_gaps.size(), 1u);
    EXPECT_NEAR(gaps.sound_gaps[0].seconds, 0.2, 0.21);
    EXPECT_TRUE(gaps.damage.empty());

    write_take("take.mkv", heard_pulse, heard_pulse + 40);
    std::vector<std::byte> bytes = bytes_of_file(at("take.mkv"));
    std::uint64_t place = 0;
    {
        const TakeReader take(at("take.mkv"));
        place = take.sounds()[3].samples.at + 100;
    }
    bytes[place] ^= std::byte{1};
    write_bytes(at("damaged.mkv"), bytes);
    const TakeReader damaged(at("damaged.mkv"));
    const TakeVerdict verdict = check_take(damaged);
    ASSERT_EQ(verdict.damage.size(), 1u);
    EXPECT_NE(verdict.damage[0].words.find("sound"), std::string::npos);
    EXPECT_EQ(copy_takes({&damaged}, 0, ~std::uint64_t{0}, at("mended.mkv")).damaged, 1u);
    EXPECT_TRUE(check_take(TakeReader(at("mended.mkv"))).damage.empty());
}

TEST_F(TakeSoundTest, ARecorderKeepsWhatIsHeardSinceTheFirstExposure) {
    TakeRecorder::Settings settings;
    settings.rigs = {"left"};
    settings.pulse_rate_hz = take_rate_hz;
    settings.program = "a test";
    settings.has_sound = true;
    settings.disk_mb_s = [](const std::filesystem::path&) { return 1000.0; };
    TakeRecorder recorder(settings);
    recorder.begin(at("take.mkv"));
    // Sound comes sooner than the picture of its time.
    std::int64_t heard = sound_of_pulse(heard_pulse) - 4800;
    const auto hear_until = [&](std::int64_t until) {
        for (; heard < until; heard += 480) recorder.offer(SoundBlock{heard, tone(heard, 480)});
    };
    for (std::uint64_t pulse = heard_pulse; pulse < heard_pulse + 50; ++pulse) {
        hear_until(sound_of_pulse(pulse + 10));
        ArrivedFrame frame;
        frame.rig = 0;
        frame.packed = std::make_shared<const PackedFrame>(sent_frame("left", pulse));
        frame.arrival = MonotonicClock::now();
        frame.arrival_tai = TaiClock::now();
        recorder.offer(frame);
    }
    recorder.finish();
    EXPECT_EQ(recorder.state().failure, "");
    EXPECT_EQ(recorder.state().sound_dropped, 0u);
    const TakeReader take(at("take.mkv"));
    ASSERT_FALSE(take.sounds().empty());
    EXPECT_EQ(take.sounds().front().first, sound_of_pulse(heard_pulse));
    EXPECT_EQ(take.sounds().back().end(), heard);
    for (std::size_t i = 1; i < take.sounds().size(); ++i)
        EXPECT_EQ(take.sounds()[i].first, take.sounds()[i - 1].end());
    expect_tone(take);
    EXPECT_NEAR(recorder.state().sound_s, 2.4, 0.1);
}

}  // namespace
}  // namespace vantage
