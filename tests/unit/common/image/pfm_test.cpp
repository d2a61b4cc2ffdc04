#include "common/image/pfm.h"

#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "common/base/files/atomic_file.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

class PfmTest : public testing::Test {
  protected:
    std::filesystem::path write(const std::string& content) const {
        const auto path = folder_.path() / "a.pfm";
        write_file_atomically(path, std::as_bytes(std::span(content)));
        return path;
    }
    /// The sentence that reading this file ends in; empty where it does not.
    std::string refusal_of(const std::string& content) const {
        const auto path = write(content);
        const std::string sentence = thrown_sentence([&] { read_pfm(path); });
        EXPECT_TRUE(sentence.empty() || sentence.find(path.string()) != std::string::npos);
        return sentence;
    }
    TemporaryFolder folder_;
};

std::string samples(std::initializer_list<float> values, bool little) {
    std::string bytes;
    for (const float value : values) {
        std::uint32_t word = 0;
        std::memcpy(&word, &value, 4);
        for (int i = 0; i < 4; ++i)
            bytes += static_cast<char>(word >> (8 * (little ? i : 3 - i)) & 0xff);
    }
    return bytes;
}

TEST_F(PfmTest, KeepsEveryBitThereAndBack) {
    cv::Mat1f image(3, 5);
    cv::RNG random(1);
    random.fill(image, cv::RNG::UNIFORM, -1e6, 1e6);
    image(1, 2) = std::numeric_limits<float>::infinity();
    image(2, 4) = std::numeric_limits<float>::denorm_min();
    const auto path = folder_.path() / "a.pfm";
    write_pfm(path, image);
    const cv::Mat1f back = read_pfm(path);
    ASSERT_EQ(back.size(), image.size());
    EXPECT_EQ(std::memcmp(back.data, image.data, image.total() * sizeof(float)), 0);
}

TEST_F(PfmTest, ReadsHeadersWithBlanksAndTheLineEndsOfWindows) {
    const std::string values = samples({1.5f, 2.5f}, true);
    for (const std::string header :
         {"Pf\r\n2 1\r\n-1.0\r\n", "Pf 2 1 -1 ", "Pf\n2  1\n-1.0 \n", "Pf\n2 1 \n-1\t \r\n"})
        EXPECT_EQ(read_pfm(write(header + values))(0, 1), 2.5f) << header;
    // A sample that begins with LF after a header that ends with CR alone.
    const std::string odd = std::string("\x0a\x00\x80\x3f", 4);
    const cv::Mat1f image = read_pfm(write("Pf\r1 1\r-1.0\r" + odd));
    EXPECT_GT(image(0, 0), 1.0f);
    EXPECT_NE(refusal_of("Pf\r\n2 1\r\n-1.0\r\n" + values + "x"), "");
}

TEST_F(PfmTest, WritesPartsOfLargerPictures) {
    cv::Mat1f large(6, 9);
    for (int i = 0; i < 54; ++i) large(i / 9, i % 9) = static_cast<float>(i);
    const cv::Mat1f part = large(cv::Rect(2, 1, 4, 3));
    const auto path = folder_.path() / "a.pfm";
    write_pfm(path, part);
    EXPECT_EQ(cv::norm(read_pfm(path), part, cv::NORM_INF), 0);
}

TEST_F(PfmTest, ReadsBothByteOrdersWithTheBottomRowFirst) {
    for (const bool little : {true, false}) {
        const std::string scale = little ? "-1.0" : "1.0";
        const cv::Mat1f image =
            read_pfm(write("Pf\n3 2\n" + scale + "\n" + samples({4, 5, 6, 1, 2.5f, 3}, little)));
        ASSERT_EQ(image.size(), cv::Size(3, 2));
        EXPECT_EQ(image(0, 0), 1);
        EXPECT_EQ(image(0, 1), 2.5f);
        EXPECT_EQ(image(1, 2), 6);
    }
}

TEST_F(PfmTest, TakesOnlyTheSignOfTheScale) {
    const cv::Mat1f image = read_pfm(write("Pf\n1 1\n-0.003922\n" + samples({7}, true)));
    EXPECT_EQ(image(0, 0), 7);
}

TEST_F(PfmTest, RefusesTruncatedAndPaddedFiles) {
    const std::string whole = "Pf\n2 2\n-1\n" + samples({1, 2, 3, 4}, true);
    EXPECT_EQ(refusal_of(whole), "");
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_NE(refusal_of(whole.substr(0, length)), "") << length << " bytes";
    EXPECT_NE(refusal_of(whole + '\0').find("16 bytes"), std::string::npos);
}

TEST_F(PfmTest, RefusesAHeaderThatIsAllThereIs) {
    // As many bytes as three samples have.
    EXPECT_NE(refusal_of("Pf 3 1 -1.00"), "");
}

TEST_F(PfmTest, RefusesSizesThatCannotBe) {
    EXPECT_NE(refusal_of("Pf\n16385 1\n-1\n").find("16384"), std::string::npos);
    EXPECT_NE(refusal_of("Pf\n99999999999 99999999999\n-1\n").find("header"), std::string::npos);
    EXPECT_NE(refusal_of("Pf\n-4 4\n-1\n").find("header"), std::string::npos);
    EXPECT_NE(refusal_of("Pf\n0 4\n-1\n").find("header"), std::string::npos);
    EXPECT_NE(refusal_of("Pf\n16384 16384\n-1\nabcd").find("holds 4"), std::string::npos);
}

TEST_F(PfmTest, RefusesWhatIsNoOneChannelPfm) {
    EXPECT_NE(refusal_of("PF\n1 1\n-1\n" + samples({1, 2, 3}, true)).find("one-channel"),
              std::string::npos);
    EXPECT_NE(refusal_of("").find("Pf"), std::string::npos);
    EXPECT_NE(refusal_of("Pf\n1 1\n0\n" + samples({1}, true)).find("scale"), std::string::npos);
    EXPECT_NE(refusal_of("Pf\n1 1\nnan\n" + samples({1}, true)).find("scale"), std::string::npos);
    EXPECT_NE(thrown_sentence([&] { read_pfm(folder_.path() / "missing.pfm"); }), "");
}

}  // namespace
}  // namespace vantage
