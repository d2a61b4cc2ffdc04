#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <poll.h>
#include <sys/mman.h>

#include "rig_firmware/capture/dma_buf_access.h"
#include "rig_firmware/capture/v4l2/v4l2_camera.h"

namespace vantage {
namespace {

constexpr int width = 320, height = 180;

/// vivid's webcam, which shows bars of colour that stand still.
V4l2Camera open_webcam(const std::string& format) {
    return V4l2Camera({.path = "/dev/video14",
                       .width_px = width,
                       .height_px = height,
                       .rate_hz = 10,
                       .pixel_format = format,
                       .controls = {{"Test Pattern", 0}, {"osd text mode", 2}},
                       .share_buffers = true});
}

SensorPicture take_from(V4l2Camera& camera) {
    for (;;) {
        if (auto picture = camera.take()) return std::move(*picture);
        pollfd wait{.fd = camera.fd(), .events = POLLIN, .revents = 0};
        ::poll(&wait, 1, 1000);
    }
}

TEST(V4l2Formats, ShowTheSamePictureInEachThatTheDriverOffers) {
    std::vector<std::string> tested;
    ColourImage grey, colour;
    for (const std::string format : {"GREY", "Y10 ", "Y16 ", "YUYV", "NV12"}) {
        bool is_offered = false;
        for (const V4l2Format& offered : V4l2Device("/dev/video14").formats())
            is_offered = is_offered || fourcc_text(offered.fourcc) == format;
        if (!is_offered) continue;
        tested.push_back(format);
        V4l2Camera camera = open_webcam(format);
        const ColourImage picture = take_from(camera).colour;
        ASSERT_EQ(picture.size(), cv::Size(width, height)) << format;
        const bool is_colour = format == "YUYV" || format == "NV12";
        ColourImage& first = is_colour ? colour : grey;
        if (first.empty()) first = picture;
        double most = 0;
        cv::minMaxLoc(cv::Mat(picture).reshape(1), nullptr, &most);
        EXPECT_GT(most, 150) << format << " shows bars, and white among them";
        EXPECT_LT(cv::norm(picture, first, cv::NORM_L1) / static_cast<double>(picture.total()), 12)
            << format << " differs from the first of its kind";
    }
    std::string names;
    for (const std::string& name : tested) names += " " + name;
    std::printf("hil: formats%s\n", names.c_str());
    EXPECT_GE(tested.size(), 4u);
}

TEST(V4l2Formats, SharedBuffersAreTheVeryMemoryThatTheDriverFills) {
    V4l2Camera camera = open_webcam("YUYV");
    camera.lend();
    const SensorPicture picture = take_from(camera);
    ASSERT_TRUE(picture.lent);
    ASSERT_GE(picture.lent->dma_buf, 0) << "VIDIOC_EXPBUF";
    const std::span<const std::byte> seen = picture.lent->raw.bytes;
    ASSERT_GE(seen.size(), static_cast<std::size_t>(2 * width * height));
    void* shared = ::mmap(nullptr, seen.size(), PROT_READ, MAP_SHARED, picture.lent->dma_buf, 0);
    ASSERT_NE(shared, MAP_FAILED);
    {
        const DmaBufAccess access(picture.lent->dma_buf);
        EXPECT_EQ(std::memcmp(shared, seen.data(), seen.size()), 0);
    }
    ::munmap(shared, seen.size());
    int values = 0;
    for (const std::byte byte : seen.first(2 * width))
        values |= 1 << (std::to_integer<int>(byte) >> 5);
    EXPECT_GT(std::popcount(static_cast<unsigned>(values)), 2) << "a picture, not empty memory";
}

}  // namespace
}  // namespace vantage
