#include "common/base/library_log.h"

#include <array>

#include <gtest/gtest.h>

#include "common/base/refused_inputs.h"

namespace vantage {
namespace {

TEST(LibraryLog, LimitsAndCountsTheMessagesOfALibrary) {
    LibraryLog log("libexample", LogLevel::warning);
    testing::internal::CaptureStderr();
    for (int i = 0; i < 400; ++i) log.note("a caller is refused\n");
    const std::string text = testing::internal::GetCapturedStderr();
    EXPECT_NE(text.find("libexample: a caller is refused"), std::string::npos) << text;
    EXPECT_EQ(text.find("libexample", text.find("libexample") + 1), std::string::npos) << text;
    std::uint64_t counted = 0;
    for (const auto& [library, count] : LibraryLog::counts())
        if (library == "libexample") counted = count;
    EXPECT_EQ(counted, 400u);
}

TEST(LibraryLog, LeavesOutTheSeparatorOfAPrefixThatIsSwitchedOff) {
    LibraryLog log("libother", LogLevel::warning);
    testing::internal::CaptureStderr();
    log.note(": KMREQ/rcv: (snd) Rx process failure - BADSECRET");
    log.note(": ");
    const std::string text = testing::internal::GetCapturedStderr();
    EXPECT_NE(text.find("libother: KMREQ/rcv"), std::string::npos) << text;
}

TEST(RefusedInputs, KeepTheLastOfEachDecoder) {
    std::array<std::byte, 300> bytes{};
    bytes[0] = std::byte{0xfe};
    testing::internal::CaptureStderr();
    note_refused_input("example", std::span(bytes).first(2), "too short");
    note_refused_input("example", bytes, "too long");
    const std::string text = testing::internal::GetCapturedStderr();
    EXPECT_NE(text.find("refused input of example (too short), 2 bytes: fe00"), std::string::npos)
        << text;
    EXPECT_EQ(text.find("too long"), std::string::npos) << "one line a minute";
    for (const RefusedInput& input : refused_inputs()) {
        if (input.decoder != "example") continue;
        EXPECT_EQ(input.reason, "too long");
        EXPECT_EQ(input.bytes, 300u);
        EXPECT_EQ(input.count, 2u);
        EXPECT_EQ(input.hex.size(), 2 * max_refused_bytes);
        EXPECT_TRUE(input.hex.starts_with("fe00"));
        return;
    }
    FAIL() << "nothing is kept";
}

}  // namespace
}  // namespace vantage
