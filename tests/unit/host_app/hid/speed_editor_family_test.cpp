#include <deque>

#include <gtest/gtest.h>

#include "tests/support/thrown_sentence.h"
#include "tests/unit/host_app/hid/decoded.h"

namespace vantage {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Events = std::vector<JogEvent>;

/// The feature report of a step of the opening, with its number.
Bytes feature(std::uint8_t step, std::uint64_t number) {
    Bytes report{6, step};
    for (int shift = 0; shift < 64; shift += 8)
        report.push_back(static_cast<std::uint8_t>(number >> shift));
    return report;
}

/// A device that answers feature reports as it is told and keeps what it is sent.
class AnsweringPort final : public JogPort {
  public:
    Bytes read(std::chrono::milliseconds) override { return {}; }
    void write(std::span<const std::uint8_t> report) override {
        written.emplace_back(report.begin(), report.end());
    }
    void send_feature(std::span<const std::uint8_t> report) override {
        features.emplace_back(report.begin(), report.end());
    }
    Bytes get_feature(std::uint8_t id, std::size_t size) override {
        EXPECT_EQ(id, 6);
        EXPECT_EQ(size, 10u);
        Bytes answer = answers.front();
        answers.pop_front();
        return answer;
    }
    /// One opening in order, that holds for 600 s.
    void expect_opening(std::uint64_t challenge = 0x0123456789abcdef) {
        answers.insert(answers.end(), {feature(0, challenge),
                                       {6, 2, 0, 0, 0, 0, 0, 0, 0, 0},
                                       {6, 4, 0x58, 0x02, 0, 0, 0, 0, 0, 0}});
    }

    std::vector<Bytes> written, features;
    std::deque<Bytes> answers;
};

void open(AnsweringPort& port) { decoder_of("1edb:da0e")->start(port, monotonic_from_ns(0)); }

TEST(SpeedEditorHandshake, AnswersChallengesAsTheDeviceExpects) {
    // Made with the published procedure (bmd.py).
    constexpr std::uint64_t pairs[][2] = {{0x0, 0x3ae1206f97c10bc8},
                                          {0x1, 0x2b9ab32bebf244c6},
                                          {0x0123456789abcdef, 0xe5c7b689e9967608},
                                          {0xfedcba9876543210, 0xc4a7da4761c769e8},
                                          {0xdeadbeefcafef00d, 0x6a04b6fcff2b4b21},
                                          {0x7, 0x751bf623f42e0ade},
                                          {0xffffffffffffffff, 0x61a3f6474ff236c6},
                                          {0x8000000000000006, 0x7d7ff8188135a889}};
    for (const auto& [challenge, response] : pairs) {
        AnsweringPort port;
        port.expect_opening(challenge);
        open(port);
        EXPECT_EQ(port.features.at(2), feature(3, response)) << std::hex << challenge;
    }
}

TEST(SpeedEditorHandshake, RunsItsStepsInOrder) {
    AnsweringPort port;
    port.expect_opening();
    open(port);
    EXPECT_EQ(port.features,
              (std::vector<Bytes>{{6, 0, 0, 0, 0, 0, 0, 0, 0, 0},
                                  {6, 1, 0, 0, 0, 0, 0, 0, 0, 0},
                                  {6, 3, 0x08, 0x76, 0x96, 0xe9, 0x89, 0xb6, 0xc7, 0xe5}}));
}

TEST(SpeedEditorHandshake, SaysAtWhichStepTheDeviceWentAstray) {
    AnsweringPort port;
    port.answers = {{6, 0, 5, 0, 0, 0, 0, 0, 0, 0}, {6, 9, 0, 0, 0, 0, 0, 0, 0, 0}};
    EXPECT_NE(thrown_sentence([&] { open(port); }).find("at step 2"), std::string::npos);
    port.answers = {{6}};
    EXPECT_NE(thrown_sentence([&] { open(port); }).find("at step 0"), std::string::npos);
}

class SpeedEditor : public testing::Test {
  protected:
    SpeedEditor() {
        port_.expect_opening();
        decoder_->start(port_, now_);
    }
    Events keys(std::uint16_t a = 0, std::uint16_t b = 0) {
        return decoded(*decoder_, {4, static_cast<std::uint8_t>(a), 0, static_cast<std::uint8_t>(b),
                                   0, 0, 0, 0, 0, 0, 0, 0, 0});
    }
    std::unique_ptr<JogDecoder> decoder_ = decoder_of("1edb:da0e");
    AnsweringPort port_;
    MonotonicTime now_ = monotonic_from_ns(0);
};

TEST_F(SpeedEditor, CountsStepsFromTheStart) {
    EXPECT_EQ(port_.written, (std::vector<Bytes>{{3, 0, 0, 0, 0, 0, 255}, {4, 1}}));
    EXPECT_EQ(decoded(*decoder_, {3, 0, 0x00, 0x02, 0, 0, 255}), Events{step("jog", 2)});
    EXPECT_EQ(decoded(*decoder_, {3, 0, 0x80, 0xff, 0xff, 0xff, 255}), Events{step("jog", -0.5)});
}

TEST_F(SpeedEditor, ReportsKeysAsTheyGoDownAndUp) {
    EXPECT_EQ(keys(0x33), Events{press("cam1")});
    EXPECT_EQ(keys(0x33, 0x3c), Events{press("stop_play")});
    EXPECT_EQ(keys(0x3c), Events{let_go("cam1")});
    EXPECT_EQ(keys(), Events{let_go("stop_play")});
}

TEST_F(SpeedEditor, BecomesAShuttleByItsOwnKeyAndAWheelAgain) {
    port_.written.clear();
    keys(0x1c);
    decoder_->keep_alive(port_, now_);
    EXPECT_EQ(port_.written, (std::vector<Bytes>{{3, 3, 0, 0, 0, 0, 255}, {4, 2}}));
    EXPECT_EQ(decoded(*decoder_, {3, 3, 0x00, 0xf8, 0xff, 0xff, 255}),
              Events{axis("shuttle", -0.5)});
    keys();
    port_.written.clear();
    EXPECT_EQ(keys(0x1d), (Events{press("jog_key"), axis("shuttle", 0)})) << "never left running";
    decoder_->keep_alive(port_, now_);
    EXPECT_EQ(port_.written, (std::vector<Bytes>{{3, 0, 0, 0, 0, 0, 255}, {4, 1}}));
}

TEST_F(SpeedEditor, IsOpenedAgainBeforeItFallsSilent) {
    port_.features.clear();
    decoder_->keep_alive(port_, now_ + std::chrono::seconds(500));
    EXPECT_TRUE(port_.features.empty());
    port_.expect_opening();
    decoder_->keep_alive(port_, now_ + std::chrono::seconds(541));
    EXPECT_EQ(port_.features.size(), 3u);
    decoder_->keep_alive(port_, now_ + std::chrono::seconds(542));
    EXPECT_EQ(port_.features.size(), 3u);
}

TEST_F(SpeedEditor, RefusesShortAndUnknownReports) {
    EXPECT_TRUE(takes(*decoder_, {7, 1, 80})) << "battery";
    EXPECT_FALSE(takes(*decoder_, {3, 0, 0, 0, 0}));
    EXPECT_FALSE(takes(*decoder_, {4, 0x33, 0}));
    EXPECT_FALSE(takes(*decoder_, {9, 1}));
    EXPECT_FALSE(takes(*decoder_, {}));
}

}  // namespace
}  // namespace vantage
