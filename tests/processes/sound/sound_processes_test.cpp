#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/base/time/pulse_grid.h"
#include "common/take/take_check.h"
#include "tests/support/child_program.h"
#include "tests/support/clicks.h"
#include "tests/support/data_folder.h"
#include "tests/support/free_ports.h"
#include "tests/support/source_folder.h"

namespace vantage {
namespace {

/// What `vantage play` and `live` do with sound, as FFmpeg finds it.
class SoundProcesses : public testing::Test {
  protected:
    SoundProcesses() {
        if (!std::filesystem::exists("/usr/bin/ffmpeg")) skipped_ = "SKIPPED: no ffmpeg";
        write_wav(file("clicks.wav"), clicks(60.5));
    }
    void SetUp() override {
        if (!skipped_.empty()) GTEST_SKIP() << skipped_;
    }
    std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
    static nlohmann::json run(const std::vector<std::string>& arguments,
                              const std::vector<std::string>& environment = {}) {
        const ProgramResult result = run_to_end(VANTAGE_PROGRAM, arguments, environment);
        EXPECT_EQ(result.status, 0) << result.err;
        return nlohmann::json::parse(result.out, nullptr, false);
    }
    nlohmann::json play(const std::string& take, std::vector<std::string> options,
                        const std::vector<std::string>& environment = {}) const {
        options.insert(options.begin(), {"play", take, "--headless", "--json", "--synth", "mesh",
                                         "--size", "96x72", "--rate", "25"});
        return run(options, environment);
    }
    /// Floats of two channels.
    std::vector<float> sound_of(const std::string& film) const {
        const ProgramResult decoded = run_to_end(
            "/usr/bin/ffmpeg",
            {"-v", "error", "-y", "-i", film, "-map", "0:a", "-f", "f32le", file("sound.raw")});
        EXPECT_EQ(decoded.status, 0) << decoded.err;
        std::vector<float> samples(std::filesystem::file_size(file("sound.raw")) / sizeof(float));
        std::ifstream(file("sound.raw"), std::ios::binary)
            .read(reinterpret_cast<char*>(samples.data()),
                  static_cast<std::streamsize>(samples.size() * sizeof(float)));
        return samples;
    }
    /// As many ticks as the film has, which a busy computer may repeat and leaves none out of.
    static std::uint64_t ticks_of(const nlohmann::json& summary) {
        const nlohmann::json& output = summary["outputs"][0];
        return output["pictures"].get<std::uint64_t>() + output["dropped"].get<std::uint64_t>();
    }

    std::string skipped_;
    TemporaryFolder folder_;
    std::string version_1_ = (source_folder() / "tests" / "takes" / "version_1.mkv").string();
};

TEST_F(SoundProcesses, AFilesSoundGoesWithAFilmToTheSample) {
    const nlohmann::json summary =
        play(version_1_, {"--audio", "file:" + file("clicks.wav"), "--record", file("film.mkv"),
                          "--seconds", "4", "--loop"});
    EXPECT_EQ(summary["sound"]["state"], "on");
    EXPECT_EQ(summary["sound"]["missing_samples"], 0);
    EXPECT_EQ(summary["sound"]["jumps"], 0);
    EXPECT_TRUE(summary["outputs"][0]["sound"]);
    EXPECT_EQ(summary["outputs"][0]["silenced"], 0);
    const std::vector<float> sound = sound_of(file("film.mkv"));
    const std::uint64_t ticks = ticks_of(summary);
    EXPECT_NEAR(static_cast<double>(sound.size() / sound_channels),
                static_cast<double>(ticks) * 1920, 1920);
    const std::vector<std::int64_t> found = found_clicks(sound);
    ASSERT_EQ(found.size(), ticks * 1920 / sound_rate_hz - (ticks * 1920 % sound_rate_hz == 0));
    for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_EQ(found[i], 48'000 * static_cast<std::int64_t>(i + 1));
}

TEST_F(SoundProcesses, ADelayThatIsAskedForIsThatOfTheFilm) {
    play(version_1_, {"--audio", file("clicks.wav"), "--audio-delay", "250", "--record",
                      file("film.mkv"), "--seconds", "3", "--loop"});
    const std::vector<std::int64_t> found = found_clicks(sound_of(file("film.mkv")));
    ASSERT_GE(found.size(), 2u);
    for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_EQ(found[i], 60'000 + 48'000 * static_cast<std::int64_t>(i));
}

TEST_F(SoundProcesses, ADeviceThatIsMissingIsNamedAndTheProgrammeGoesOn) {
    const nlohmann::json summary = play(version_1_, {"--audio", "alsa:no_such_device", "--record",
                                                     file("film.mkv"), "--frames", "10", "--loop"});
    EXPECT_EQ(summary["sound"]["state"], "failed");
    EXPECT_NE(summary["sound"]["failure"].get<std::string>().find("no_such_device"),
              std::string::npos);
    const std::vector<float> sound = sound_of(file("film.mkv"));
    EXPECT_GT(sound.size(), 0u);
    EXPECT_EQ(sound, std::vector<float>(sound.size()));
}

/// Samples that a second may have more or fewer in a take: when the pictures' delay changes, as on
/// a busy computer, sound slides there by half a percent.
constexpr double slide = 0.005 * 48'000 + 1;

/// A rig on the virtual stage whose takes have a sound.
class SoundTakes : public SoundProcesses {
  protected:
    SoundTakes() {
        const std::string endpoint = fmt::format("tcp://127.0.0.1:{}", two_free_ports().first);
        std::ofstream(file("stage.toml"))
            << "version = 1\nrate_hz = 5\nlatency_budget_ms = 5000\n[view]\nwidth_px = 96\n"
               "height_px = 64\n[[rigs]]\nname = \"left\"\nendpoint = \""
            << endpoint << "\"\n";
        std::ofstream(file("left.toml"))
            << "version = 1\nname = \"left\"\n[source]\nrate_hz = 5\nwidth_px = 96\n"
               "height_px = 72\n[match]\nmatcher = \"exact\"\ndisparities = 32\n[stream]\nbind = \""
            << endpoint << "\"\n";
    }
    /// With a click a second; where its clicks were heard, in samples.
    std::vector<std::int64_t> record(const std::string& name) const {
        ChildProgram rig(VANTAGE_RIG_PROGRAM, {"run", "--config", file("left.toml")},
                         folder_.path());
        const nlohmann::json summary =
            run({"live", "--stage", file("stage.toml"), "--headless", "--json", "--wait", "60",
                 "--synth", "mesh", "--rate", "25", "--seconds", "7", "--audio", file("clicks.wav"),
                 "--take", file(name)});
        EXPECT_EQ(summary["take"]["failure"], "");
        EXPECT_GT(summary["take"]["sound_s"], 4);
        EXPECT_EQ(summary["take"]["sound_dropped_samples"], 0);
        return heard_clicks(TakeReader(file(name)));
    }
    static std::vector<std::int64_t> heard_clicks(const TakeReader& take) {
        std::vector<float> all;
        if (take.sounds().empty()) return {};
        const std::int64_t first = take.sounds().front().first;
        for (const TakeReader::Sound& sound : take.sounds()) {
            all.resize(static_cast<std::size_t>(sound.first - first) * sound_channels);
            const std::vector<float> samples = sound_from_stored(take.load(sound));
            all.insert(all.end(), samples.begin(), samples.end());
        }
        std::vector<std::int64_t> found = found_clicks(all);
        for (std::int64_t& click : found) click += first;
        return found;
    }
};

TEST_F(SoundTakes, ATakesSoundPlaysAlongIsCutAndGoesIntoFilms) {
    const std::vector<std::int64_t> heard = record("take.mkv");
    ASSERT_GE(heard.size(), 4u);
    for (std::size_t i = 1; i < heard.size(); ++i)
        EXPECT_NEAR(static_cast<double>(heard[i] - heard[i - 1]), 48'000, slide);
    const TakeReader take(file("take.mkv"));
    EXPECT_TRUE(check_take(take).damage.empty());
    const std::int64_t begin = sound_sample_at(
        PulseGrid(take.facts().pulse_rate_hz).time_of(take.frames(0).front().pulse));

    // Played, it is where its pictures are.
    const nlohmann::json played =
        play(file("take.mkv"), {"--audio-delay", "0", "--record", file("played.mkv")});
    EXPECT_EQ(played["sound"]["missing_samples"], 0);
    const std::vector<std::int64_t> there = found_clicks(sound_of(file("played.mkv")));
    std::size_t matched = 0;
    for (const std::int64_t click : heard)
        for (const std::int64_t found : there)
            if (std::abs(click - begin - found) <= 1920) ++matched;
    EXPECT_GE(matched + 1, heard.size());
    EXPECT_EQ(matched, there.size());

    // At half its speed it is silent.
    play(file("take.mkv"), {"--speed", "0.5", "--seconds", "2", "--record", file("slow.mkv")});
    const std::vector<float> slow = sound_of(file("slow.mkv"));
    EXPECT_EQ(slow, std::vector<float>(slow.size()));

    run({"take", "cut", file("take.mkv"), "--from", "1", "--to", "4", "-o", file("cut.mkv"),
         "--json"});
    const std::vector<std::int64_t> cut = heard_clicks(TakeReader(file("cut.mkv")));
    ASSERT_GE(cut.size(), 2u);
    for (const std::int64_t click : cut)
        EXPECT_NE(std::find(heard.begin(), heard.end(), click), heard.end());
    EXPECT_NEAR(run({"take", "info", file("cut.mkv"), "--json"})["sound_s"], 3, 0.3);

    run({"take", "export", file("cut.mkv"), "--as", "film", "--size", "96x72", "--synth", "mesh",
         "--rate", "5", "-o", file("export.mkv"), "--json"});
    const std::vector<std::int64_t> film = found_clicks(sound_of(file("export.mkv")));
    EXPECT_GE(film.size(), 1u);
    for (std::size_t i = 1; i < film.size(); ++i)
        EXPECT_NEAR(static_cast<double>(film[i] - film[i - 1]), 48'000, slide);
}

TEST_F(SoundProcesses, WhatCannotBeIsSaidAtOnce) {
    for (const auto& [options, words] : {std::pair<std::vector<std::string>, std::string>{
                                             {"--audio", file("missing.wav")}, "missing.wav"},
                                         {{"--audio", "jack:somewhere"}, "alsa:DEVICE"},
                                         {{"--audio-delay", "100"}, "--audio"}}) {
        std::vector<std::string> all{"play", version_1_, "--headless"};
        all.insert(all.end(), options.begin(), options.end());
        const ProgramResult result = run_to_end(VANTAGE_PROGRAM, all);
        EXPECT_EQ(result.status, 1);
        EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
    }
}

}  // namespace
}  // namespace vantage
