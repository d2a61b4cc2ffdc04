#include "host_app/sound/picture_sound.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t begin = 1'800'000'000LL * sound_rate_hz;
constexpr double rate_hz = 50;

/// Sound that says which sample it is: it rises for a second and falls for one.
class NumberedSource final : public SoundSource {
  public:
    explicit NumberedSource(bool goes_with_ticks) : goes_with_ticks_(goes_with_ticks) {}
    std::size_t read(std::int64_t first, std::span<float> samples) override {
        for (std::size_t i = 0; i < samples.size(); ++i)
            samples[i] = value_of(first + static_cast<std::int64_t>(i / 2));
        return missing_after_ ? 0 : samples.size() / sound_channels;
    }
    bool goes_with_ticks() const override { return goes_with_ticks_; }
    SoundState state() const override { return {}; }

    static float value_of(std::int64_t sample) {
        const std::int64_t of_two_seconds = sample % (2 * sound_rate_hz);
        return static_cast<float>(std::min(of_two_seconds, 2 * sound_rate_hz - of_two_seconds)) /
               sound_rate_hz;
    }
    bool missing_after_ = false;

  private:
    bool goes_with_ticks_;
};

TaiTime at(std::int64_t samples) { return time_of_sound(begin + samples); }

class PictureSoundTest : public testing::Test {
  protected:
    void make(bool goes_with_ticks, std::optional<std::chrono::nanoseconds> delay = {}) {
        source_ = std::make_shared<NumberedSource>(goes_with_ticks);
        sound_.emplace(PictureSound::Settings{.rate_hz = rate_hz, .delay = delay}, source_);
    }
    /// Of a file; what goes into a take.
    const std::vector<SoundBlock>& make_with_tap() {
        source_ = std::make_shared<NumberedSource>(true);
        sound_.emplace(
            PictureSound::Settings{
                .rate_hz = rate_hz,
                .tap = [this](const SoundBlock& block) { taken_.push_back(block); }},
            source_);
        return taken_;
    }
    void see_live(std::chrono::nanoseconds latency) {
        for (int i = 0; i < 3; ++i) sound_->saw_live(latency);
    }
    std::shared_ptr<const SoundBlock> live(std::int64_t tick) {
        return sound_->next({at(960 * tick), at(960 * tick)});
    }
    static void expect_from(const SoundBlock& block, std::int64_t sample) {
        ASSERT_EQ(block.samples.size(), 960 * sound_channels);
        // Behind the fade.
        for (std::size_t i = 240; i < 960; ++i)
            ASSERT_EQ(block.samples[2 * i],
                      NumberedSource::value_of(sample + static_cast<std::int64_t>(i)))
                << i;
    }

    std::vector<SoundBlock> taken_;
    std::shared_ptr<NumberedSource> source_;
    std::optional<PictureSound> sound_;
};

TEST_F(PictureSoundTest, SoundIsOutputWithThePictureOfItsTime) {
    make(false);
    sound_->saw_live(300ms);
    for (std::int64_t tick = 0; tick < 100; ++tick) {
        const auto block = live(tick);
        EXPECT_EQ(block->first, 960 * tick);
        expect_from(*block, begin + 960 * tick - 14'400);
        sound_->saw_live(tick % 2 == 0 ? 304ms : 297ms);
    }
    EXPECT_EQ(sound_->state().slid, 0u);
    EXPECT_EQ(sound_->state().jumps, 0u);
    EXPECT_EQ(sound_->state().delay_ms, 300);
    EXPECT_EQ(sound_->state().played, 96'000u);
}

TEST_F(PictureSoundTest, KeepsAGivenDelay) {
    make(false, 120ms);
    sound_->saw_live(300ms);
    expect_from(*live(0), begin - 5760);
}

TEST_F(PictureSoundTest, StretchesContinuouslyForALaterPicture) {
    make(false);
    sound_->saw_live(100ms);
    float last = live(0)->samples.back();
    for (int i = 0; i < 300; ++i) sound_->saw_live(150ms);
    std::int64_t tick = 1;
    for (; tick < 1000; ++tick) {
        const auto block = live(tick);
        for (std::size_t i = 0; i < 960; ++i) {
            const float value = block->samples[2 * i];
            ASSERT_LT(std::abs(value - last) * sound_rate_hz, 1.25F) << tick << ", " << i;
            last = value;
        }
    }
    expect_from(*live(tick), begin + 960 * tick - 7200);
    EXPECT_EQ(sound_->state().slid, 2400u);
    EXPECT_EQ(sound_->state().jumps, 0u);
}

TEST_F(PictureSoundTest, CountsAJumpBeyondTheStretchLimit) {
    make(false);
    sound_->saw_live(100ms);
    live(0);
    for (int i = 0; i < 300; ++i) sound_->saw_live(400ms);
    expect_from(*live(1), begin + 960 - 19'200);
    EXPECT_EQ(sound_->state().jumps, 1u);
}

TEST_F(PictureSoundTest, IsSilentUnlessTimeAdvancesAtNormalSpeed) {
    make(false);
    sound_->next({at(0), at(-480'000)});
    sound_->next({at(960), at(-480'000 + 960)});
    const std::vector<float> silence(960 * sound_channels);
    const auto fading = sound_->next({at(1920), std::nullopt});
    EXPECT_GT(fading->samples.front(), 0) << "it fades";
    EXPECT_EQ(fading->samples.back(), 0);
    EXPECT_EQ(sound_->next({at(2880), std::nullopt})->samples, silence);
    // At half speed, led by a flight.
    sound_->next({at(3840), at(-480'000)});
    sound_->next({at(4800), at(-480'000 + 480)});
    EXPECT_EQ(sound_->next({at(5760), at(-480'000 + 960)})->samples, silence);
    // And on again.
    expect_from(*sound_->next({at(6720), at(-480'000 + 1920)}), begin - 480'000 + 1920);
    EXPECT_EQ(sound_->state().missing, 0u);
}

TEST_F(PictureSoundTest, CountsMissingSamples) {
    make(false);
    source_->missing_after_ = true;
    live(0);
    EXPECT_EQ(sound_->state().missing, 960u);
}

TEST_F(PictureSoundTest, AFileFollowsTheTicksBitForBit) {
    make(true);
    sound_->saw_live(300ms);
    for (std::int64_t tick = 0; tick < 20; ++tick) {
        const auto block = sound_->next({at(5000 * tick), std::nullopt});
        for (std::size_t i = 0; i < 960; ++i)
            ASSERT_EQ(block->samples[2 * i],
                      NumberedSource::value_of(block->first + static_cast<std::int64_t>(i)));
    }
}

TEST_F(PictureSoundTest, AFileIsRecordedAtTheTimeOfItsPictures) {
    const std::vector<SoundBlock>& taken = make_with_tap();
    see_live(300ms);
    for (std::int64_t tick = 0; tick < 5; ++tick) live(tick);
    ASSERT_EQ(taken.size(), 5u);
    for (std::size_t i = 0; i < 5; ++i)
        EXPECT_EQ(taken[i].first, begin - 14'400 + 960 * static_cast<std::int64_t>(i));
}

TEST_F(PictureSoundTest, ARecordedFileWaitsForAKnownDelay) {
    const std::vector<SoundBlock>& taken = make_with_tap();
    sound_->saw_live(900ms);
    live(0);
    EXPECT_TRUE(taken.empty());
    for (int i = 0; i < 2; ++i) sound_->saw_live(300ms);
    live(1);
    ASSERT_EQ(taken.size(), 1u);
    EXPECT_EQ(taken[0].first, begin + 960 - 14'400);
}

TEST_F(PictureSoundTest, ARecordedFileHasNoGapWhenTheDelayChanges) {
    const std::vector<SoundBlock>& taken = make_with_tap();
    see_live(600ms);
    std::int64_t tick = 0;
    for (; tick < 5; ++tick) live(tick);
    for (int i = 0; i < 20; ++i) sound_->saw_live(200ms);
    // 400 ms at half a percent.
    for (; tick < 5000; ++tick) live(tick);
    for (std::size_t i = 1; i < taken.size(); ++i) ASSERT_EQ(taken[i].first, taken[i - 1].end());
    const std::int64_t heard = begin + 960 * (tick - 1) - 200 * sound_rate_hz / 1000;
    EXPECT_NEAR(static_cast<double>(taken.back().first), static_cast<double>(heard), 240);
    // More than a second is a jump.
    for (int i = 0; i < 200; ++i) sound_->saw_live(1900ms);
    live(tick);
    EXPECT_EQ(taken.back().first, begin + 960 * tick - 1900 * sound_rate_hz / 1000);
}

}  // namespace
}  // namespace vantage
