#include <gtest/gtest.h>

#include "host_app/sound/sound_source.h"
#include "tests/support/clicks.h"
#include "tests/support/data_folder.h"
#include "tests/support/eventually.h"

namespace vantage {
namespace {

/// ALSA without a card: its own library reads the test's asoundrc, in which a device gives what is
/// in a file.
class AlsaSoundTest : public testing::Test {
  protected:
    AlsaSoundTest() {
        std::ofstream(at("asoundrc"))
            << "pcm.clicks {\n  type file\n  slave.pcm { type null }\n"
            << "  file /dev/null\n  infile " << at("clicks.raw") << "\n  format raw\n}\n"
            << "pcm.silent { type null }\n";
        setenv("ALSA_CONFIG_PATH", at("asoundrc").c_str(), 1);
    }
    ~AlsaSoundTest() override { unsetenv("ALSA_CONFIG_PATH"); }
    std::string at(const std::string& name) const { return (folder_.path() / name).string(); }
    void write_clicks() const {
        std::ofstream out(at("clicks.raw"), std::ios::binary);
        for (const float value : clicks(30.5)) {
            const auto whole = static_cast<std::int32_t>(value * 2147483392.0F);
            out.write(reinterpret_cast<const char*>(&whole), sizeof whole);
        }
    }
    TemporaryFolder folder_;
};

TEST_F(AlsaSoundTest, DeliversTheDevicesSoundWithItsTimes) {
    write_clicks();
    std::mutex mutex;
    std::vector<SoundBlock> tapped;
    const auto source = open_sound("alsa:clicks?channels=2,2", [&](const SoundBlock& block) {
        const std::lock_guard lock(mutex);
        tapped.push_back(block);
    });
    EXPECT_FALSE(source->goes_with_ticks());
    ASSERT_TRUE(eventually([&] { return source->state().heard > 4 * sound_rate_hz; }));
    EXPECT_EQ(source->state().phase, SoundPhase::on);
    EXPECT_EQ(source->state().failures, 0u);
    const std::lock_guard lock(mutex);
    std::vector<float> sound;
    for (std::size_t i = 0; i < tapped.size(); ++i) {
        EXPECT_TRUE(i == 0 || tapped[i].first >= tapped[i - 1].end());
        sound.resize(static_cast<std::size_t>(tapped[i].first - tapped[0].first) * sound_channels);
        sound.insert(sound.end(), tapped[i].samples.begin(), tapped[i].samples.end());
    }
    for (std::size_t i = 0; i < sound.size(); i += 2)
        ASSERT_EQ(sound[i], sound[i + 1]) << "both are the second channel";
    EXPECT_GE(found_clicks(sound).size(), 3u);
    std::vector<float> read(tapped.back().samples.size());
    EXPECT_EQ(source->read(tapped.back().first, read), read.size() / sound_channels);
    EXPECT_EQ(read, tapped.back().samples);
}

TEST_F(AlsaSoundTest, ReportsAMissingDeviceAndRecovers) {
    const auto source = open_sound("alsa:clicks", {});
    ASSERT_TRUE(eventually([&] { return source->state().phase == SoundPhase::failed; }));
    EXPECT_NE(source->state().failure.find("clicks"), std::string::npos) << source->state().failure;
    std::vector<float> silence(480 * sound_channels, 1.0F);
    EXPECT_EQ(source->read(0, silence), 0u);
    EXPECT_EQ(silence, std::vector<float>(480 * sound_channels));
    write_clicks();
    ASSERT_TRUE(eventually([&] { return source->state().phase == SoundPhase::on; }));
    EXPECT_EQ(source->state().failure, "");
    EXPECT_EQ(source->state().failures, 1u);
    ASSERT_TRUE(eventually([&] { return source->state().heard > 0; }));
}

}  // namespace
}  // namespace vantage
