// The programme on a loopback device (v4l2loopback), as ffmpeg sees it there.
#include <cstdint>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/child_process.h"
#include "host_app/output/output_target.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

/// Its bytes fill no whole number of memory's pages.
constexpr int output_width = 320, output_height = 180;
const OutputFormat format{.width_px = output_width, .height_px = output_height, .rate_hz = 10};

TEST(V4l2Output, IsACameraThatFfmpegReads) {
    constexpr int left = 40, right = 200;  // grey levels
    ColourImage picture(output_height, output_width, cv::Vec4b(left, left, left, 255));
    picture.colRange(output_width / 2, output_width) = cv::Vec4b(right, right, right, 255);
    const OutputPatience patience;
    const auto target = plan_output("v4l2:/dev/video20", format).open(patience);
    target->write(picture, 0, "");  // a loopback device is a camera from its first picture on
    std::jthread programme([&](const std::stop_token& stop) {
        for (std::int64_t tick = 1; !stop.stop_requested(); ++tick) {
            target->write(picture, tick, "");
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        }
    });
    const TemporaryFolder folder;
    const std::filesystem::path seen = folder.path() / "seen.yuv", said = folder.path() / "said";
    constexpr std::size_t pictures = 3,
                          picture_bytes = std::size_t{2} * output_width * output_height;
    const int status =
        ChildProcess({.program = "/usr/bin/ffmpeg",
                      .arguments = {"-v", "error", "-f", "v4l2", "-i", "/dev/video20", "-frames:v",
                                    std::to_string(pictures), "-c", "copy", "-f", "rawvideo", seen},
                      .err = said})
            .wait();
    std::ifstream words(said);
    ASSERT_EQ(status, 0) << std::string(std::istreambuf_iterator<char>(words), {});
    std::ifstream file(seen, std::ios::binary);
    const std::vector<char> bytes(std::istreambuf_iterator<char>(file), {});
    ASSERT_EQ(bytes.size(), pictures * picture_bytes);
    const auto luma = [&](int x, int y) {  // of the second
        const auto at = static_cast<std::size_t>(y * output_width + x) * 2;
        return static_cast<int>(static_cast<std::uint8_t>(bytes[picture_bytes + at]));
    };
    const auto of_grey = [](int level) { return 16 + level * 219 / 255; };
    for (const int y : {0, output_height / 2, output_height - 1}) {
        EXPECT_NEAR(luma(10, y), of_grey(left), 1) << "row " << y;
        EXPECT_NEAR(luma(output_width - 10, y), of_grey(right), 1) << "row " << y;
    }
    EXPECT_GE(target->bytes(), pictures * picture_bytes);
}

TEST(V4l2Output, RefusesACamera) {
    const OutputPatience patience;
    const std::string sentence =
        thrown_sentence([&] { plan_output("v4l2:/dev/video14", format).open(patience); });
    EXPECT_NE(sentence.find("/dev/video14 takes no pictures"), std::string::npos) << sentence;
}

}  // namespace
}  // namespace vantage
