#include <gtest/gtest.h>

#include "host_app/sound/sound_source.h"
#include "tests/support/child_program.h"
#include "tests/support/clicks.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

class FileSoundTest : public testing::Test {
  protected:
    std::string at(const std::string& name) const { return (folder_.path() / name).string(); }
    static std::vector<float> all_of(SoundSource& source, double seconds) {
        std::vector<float> sound;
        for (std::int64_t first = 0; first < static_cast<std::int64_t>(seconds * sound_rate_hz);
             first += 960) {
            std::vector<float> part(960 * sound_channels);
            // No clock is asked: what is not read yet will be.
            while (source.read(first, part) < 960 && source.state().phase == SoundPhase::on)
                std::this_thread::yield();
            sound.insert(sound.end(), part.begin(), part.end());
        }
        return sound;
    }
    TemporaryFolder folder_;
};

TEST_F(FileSoundTest, IsExactToTheSampleAndEndsInSilence) {
    write_wav(at("clicks.wav"), clicks(20.3));
    const auto source = open_sound("file:" + at("clicks.wav"), {});
    EXPECT_TRUE(source->goes_with_ticks());
    const std::vector<float> sound = all_of(*source, 25);
    const std::vector<float> written = clicks(20.3);
    for (std::size_t i = 0; i < written.size(); ++i) ASSERT_NEAR(sound[i], written[i], 1e-4) << i;
    for (std::size_t i = written.size(); i < sound.size(); ++i) ASSERT_EQ(sound[i], 0);
    EXPECT_EQ(source->state().phase, SoundPhase::ended);
    EXPECT_EQ(source->state().heard, written.size() / sound_channels);
    std::vector<float> before(10 * sound_channels);
    EXPECT_EQ(source->read(-10, before), 10u) << "it is silent before its beginning by right";
}

TEST_F(FileSoundTest, Loops) {
    write_wav(at("clicks.wav"), clicks(1.5));
    const auto source = open_sound(at("clicks.wav") + "?loop=yes", {});
    const std::vector<std::int64_t> found = found_clicks(all_of(*source, 12));
    ASSERT_GE(found.size(), 7u);
    for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_EQ(found[i], 48'000 + 72'000 * static_cast<std::int64_t>(i));
}

TEST_F(FileSoundTest, ReadsAnyRateAndCodec) {
    write_wav(at("clicks.wav"), clicks(3.5), 44'100);
    const auto wav = open_sound(at("clicks.wav"), {});
    const std::vector<std::int64_t> found = found_clicks(all_of(*wav, 4));
    ASSERT_EQ(found.size(), 3u);
    for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_NEAR(static_cast<double>(found[i]),
                    (static_cast<double>(i) + 1) * 48'000 * 48 / 44.1, 24);
    if (!std::filesystem::exists("/usr/bin/ffmpeg")) GTEST_SKIP() << "SKIPPED: no ffmpeg";
    write_wav(at("clicks.wav"), clicks(3.5));
    for (const char* name : {"clicks.flac", "clicks.m4a", "clicks.opus"}) {
        const ProgramResult coded = run_to_end(
            "/usr/bin/ffmpeg", {"-v", "error", "-i", at("clicks.wav"), "-ac", "2", at(name)});
        ASSERT_EQ(coded.status, 0) << coded.err;
        const std::vector<std::int64_t> there = found_clicks(all_of(*open_sound(at(name), {}), 4));
        ASSERT_EQ(there.size(), 3u) << name;
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(static_cast<double>(there[i]), 48'000 * (static_cast<double>(i) + 1), 240)
                << name;
    }
}

TEST_F(FileSoundTest, NamesInvalidSources) {
    std::ofstream(at("words.txt")) << "no sound";
    for (const std::string& url :
         {at("words.txt"), at("missing.wav"), std::string("http://somewhere/a.wav"),
          std::string("alsa:hw:1?channels=0"), std::string("alsa:hw:1?channels=1,2,3")}) {
        const std::string sentence = thrown_sentence([&] { check_sound(url); });
        EXPECT_NE(sentence, "") << url;
        EXPECT_NE(sentence.find(url.substr(0, url.find('?'))), std::string::npos) << sentence;
    }
}

}  // namespace
}  // namespace vantage
