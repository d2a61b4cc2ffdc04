#include <fstream>

#include <gtest/gtest.h>

#include "host_app/replay/clip.h"
#include "tests/support/data_folder.h"
#include "tests/support/source_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

class ClipFile : public testing::Test {
  protected:
    static ClipBook example() {
        ClipBook book;
        book.pulse_rate_hz = 29.97;
        book.programme_speed = 0.33;
        book.list_loops = true;
        book.clips[2] = {.name = "the \"leap\"",
                         .in = 53'000'000'000,
                         .out = 53'000'000'100,
                         .speed = 0.5,
                         .guard_s = 1,
                         .shot = 4};
        book.clips[7] = {.in = 53'000'000'200, .out = 53'000'000'201};
        book.list = {{.clip = 7}, {.clip = 2, .speed = 0.25}};
        return book;
    }
    void write(const std::string& text) const { std::ofstream(file_) << text; }
    std::string refusal_of(const std::string& rest) const {
        write("version = 1\npulse_rate_hz = 25\n" + rest);
        return thrown_sentence([&] { (void)load_clips(file_, 25); });
    }
    void expect_refused(const std::string& rest, const std::string& words) const {
        EXPECT_NE(refusal_of(rest).find(words), std::string::npos) << refusal_of(rest);
    }

    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_.path() / "stage.clips.toml";
};

TEST_F(ClipFile, DocumentedExampleLoads) {
    const ClipBook book = load_clips(source_folder() / "hw_config/clips.toml", 25);
    EXPECT_EQ(book.clips.at(1).name, "the leap");
    EXPECT_EQ(book.list.size(), 1u);
}

TEST_F(ClipFile, SurvivesARoundTrip) {
    write(to_toml(example()));
    EXPECT_EQ(load_clips(file_, 29.97), example());
}

TEST_F(ClipFile, RejectsInvalidValuesWithTheLine) {
    EXPECT_EQ(refusal_of(""), "");
    expect_refused("[[clip]]\nnumber = 1\nin_pulse = 5\nout_pulse = 5\n",
                   ":6: 'out_pulse' in [[clip]] is not after in_pulse");
    expect_refused("[[clip]]\nnumber = 100\nin_pulse = 5\nout_pulse = 6\n", "number");
    expect_refused("[[clip]]\nnumber = 1\nin_pulse = 5\n", "out_pulse");
    expect_refused("[[clip]]\nnumber = 1\nin_pulse = -5\nout_pulse = 6\n", "in_pulse");
    expect_refused("[[clip]]\nnumber = 1\nin_pulse = 5\nout_pulse = 6\nspeed = 0\n", "speed");
    expect_refused(
        "[[clip]]\nnumber = 1\nin_pulse = 5\nout_pulse = 6\n"
        "[[clip]]\nnumber = 1\nin_pulse = 5\nout_pulse = 6\n",
        "for the second time");
    expect_refused("[[entry]]\nclip = 3\n", "the file has no such clip");
    expect_refused("mix = true\n", "mix");
}

TEST_F(ClipFile, RejectsAnotherVersionAndAnotherRate) {
    write("version = 2\npulse_rate_hz = 25\n");
    EXPECT_NE(thrown_sentence([&] { (void)load_clips(file_, 25); }).find("version"),
              std::string::npos);
    write("version = 1\npulse_rate_hz = 25\n");
    const std::string sentence = thrown_sentence([&] { (void)load_clips(file_, 50); });
    EXPECT_NE(sentence.find("--clips"), std::string::npos) << sentence;
}

TEST_F(ClipFile, IsWrittenOnlyAfterAChange) {
    EXPECT_EQ(clip_file_of("a/take.mkv"), "a/take.clips.toml");
    ClipStore store(file_, 29.97);
    store.follow(std::make_shared<const ClipBook>(store.book()), MonotonicClock::now() + 1h);
    store.finish();
    EXPECT_FALSE(std::filesystem::exists(file_)) << "nothing was changed";
    const auto changed = std::make_shared<const ClipBook>(example());
    store.follow(changed, MonotonicClock::now());
    EXPECT_FALSE(std::filesystem::exists(file_)) << "not yet";
    store.follow(changed, MonotonicClock::now() + 1h);
    EXPECT_EQ(load_clips(file_, 29.97), example());
    std::ofstream(file_) << "# by another program\n";
    ClipBook other = example();
    other.list.clear();
    store.follow(std::make_shared<const ClipBook>(other), MonotonicClock::now());
    store.finish();
    EXPECT_EQ(load_clips(file_, 29.97), other);
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / "stage.clips-2.toml"))
        << "the file of another program stays";
}

}  // namespace
}  // namespace vantage
