#include "rig_firmware/capture/camera_intake.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/rectification/rectify_pass.h"
#include "common/rectification/rectify_reference.h"
#include "rig_firmware/capture/buffer_lender.h"
#include "tests/support/shared_memory.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

constexpr int width = 62, height = 46;
constexpr std::size_t bytes_per_line = 192;  ///< more than any format needs
constexpr std::size_t picture_bytes = bytes_per_line * (height + height / 2);

const auto uncompressed = {PixelFormat::yuyv, PixelFormat::nv12, PixelFormat::grey,
                           PixelFormat::y10, PixelFormat::y16};

void fill_randomly(std::span<std::byte> bytes, std::uint64_t seed) {
    cv::RNG random(seed);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random.uniform(0, 256));
}

LentPicture lent(PixelFormat format, std::span<const std::byte> bytes, int dma_buf = -1) {
    LentPicture picture;
    picture.raw = {format, width, height, bytes_per_line, bytes.first(picture_bytes)};
    picture.view = {0, 0, width, height};
    picture.dma_buf = dma_buf;
    return picture;
}

class CameraIntakeTest : public testing::Test {
  protected:
    CameraIntakeTest() : bytes_(picture_bytes) { fill_randomly(bytes_, 5); }

    EglContext context_;
    ShaderLibrary library_;
    std::vector<std::byte> bytes_;
};

TEST_F(CameraIntakeTest, CopiesAndConvertsOnTheGpuAsTheProcessorWould) {
    CameraIntake intake(context_, library_, {width, height});
    std::uint64_t brought = 0;
    for (const PixelFormat format : uncompressed) {
        const LentPicture picture = lent(format, bytes_);
        const cv::Mat converted = intake.bring(picture).download();
        EXPECT_EQ(cv::norm(converted, to_colour(picture.raw), cv::NORM_INF), 0)
            << fourcc_text(fourcc_of(format));
        EXPECT_EQ(intake.counts().copied, ++brought);
    }
    EXPECT_EQ(intake.counts().imported, 0u);
}

TEST_F(CameraIntakeTest, TakesHalfOfAPictureThatHoldsBothSides) {
    CameraIntake intake(context_, library_, {width / 2 - 1, height});
    for (const PixelFormat format : uncompressed) {
        LentPicture picture = lent(format, bytes_);
        picture.view = {width / 2 + 1, 0, width / 2 - 1, height};
        EXPECT_EQ(cv::norm(intake.bring(picture).download(), to_colour(picture.raw)(picture.view),
                           cv::NORM_INF),
                  0)
            << fourcc_text(fourcc_of(format));
    }
}

/// A calibration of two cameras that look towards each other.
StereoCalibration toed_in(int width_px) {
    StereoCalibration calibration;
    CameraModel camera;
    camera.width_px = width_px;
    camera.height_px = height;
    camera.fx_px = camera.fy_px = 0.9 * width;
    camera.cx_px = 0.48 * width_px;
    camera.cy_px = 0.53 * height;
    calibration.left = calibration.right = camera;
    calibration.right_from_left.linear() =
        Eigen::AngleAxisd(0.04, Eigen::Vector3d(0.3, 1.0, 0.2).normalized()).toRotationMatrix();
    calibration.right_from_left.translation() = Eigen::Vector3d(-0.12, 0.003, 0.002);
    compute_rectification(calibration, 1);  // shows what lies outside, too
    return calibration;
}

/// Y, U, V and 255 of each pixel.
ColourImage yuv_of(const LentPicture& picture) {
    const auto byte = [&](std::size_t row, int column) {
        return std::to_integer<unsigned char>(
            picture.raw.bytes[row * bytes_per_line + static_cast<std::size_t>(column)]);
    };
    ColourImage yuv(height, width);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto row = static_cast<std::size_t>(y);
            const int pair = x / 2 * 2;
            if (picture.raw.format == PixelFormat::yuyv)
                yuv(y, x) = {byte(row, 2 * x), byte(row, 2 * pair + 1), byte(row, 2 * pair + 3),
                             255};
            else
                yuv(y, x) = {byte(row, x), byte(static_cast<std::size_t>(height + y / 2), pair),
                             byte(static_cast<std::size_t>(height + y / 2), pair + 1), 255};
        }
    return yuv;
}

TEST_F(CameraIntakeTest, PlanesAreRectifiedAsTheCpuDoesBitForBit) {
    for (const cv::Rect& view :
         {cv::Rect(0, 0, width, height), cv::Rect(width / 2 + 1, 0, width / 2 - 1, height)}) {
        const StereoCalibration calibration = toed_in(view.width);
        const cv::Mat2f positions = make_rectification_map(calibration, Side::left);
        CameraIntake intake(context_, library_, view.size());
        RectifyPass rectify(library_, calibration, Side::left);
        for (const PixelFormat format : uncompressed) {
            LentPicture picture = lent(format, bytes_);
            picture.view = view;
            const bool is_yuv = format == PixelFormat::yuyv || format == PixelFormat::nv12;
            const ColourImage expected =
                is_yuv ? rectify_yuv_reference(yuv_of(picture)(view), positions)
                       : rectify_reference(to_colour(picture.raw)(view), positions);
            const cv::Mat rectified = rectify.rectify(intake.planes(picture)).download();
            EXPECT_EQ(cv::norm(rectified, expected, cv::NORM_INF), 0)
                << fourcc_text(fourcc_of(format)) << " from column " << view.x;
        }
        EXPECT_EQ(intake.counts().copied, uncompressed.size());
    }
}

TEST(RectifyYuv, DiffersFromRectifyingTheConvertedPictureByRoundingAlone) {
    // A smooth picture: chroma of two pixels lies between them in one order and not in the other.
    ColourImage yuv(40, 60);
    for (int y = 0; y < yuv.rows; ++y)
        for (int x = 0; x < yuv.cols; ++x)
            yuv(y, x) = cv::Vec4b(static_cast<unsigned char>(60 + 2 * x),
                                  static_cast<unsigned char>(100 + y), 140, 255);
    cv::Mat2f as_it_is(yuv.size()), moved(yuv.size());
    for (int y = 0; y < yuv.rows; ++y)
        for (int x = 0; x < yuv.cols; ++x) {
            const auto column = static_cast<float>(x), row = static_cast<float>(y);
            as_it_is(y, x) = {column, row};
            moved(y, x) = {column * 0.97F + 0.3F, row * 0.95F + 0.4F};
        }
    const ColourImage converted = rectify_yuv_reference(yuv, as_it_is);
    EXPECT_LE(cv::norm(rectify_yuv_reference(yuv, moved), rectify_reference(converted, moved),
                       cv::NORM_INF),
              2);
}

TEST_F(CameraIntakeTest, SaysWhyItCopies) {
    CameraIntake intake(context_, library_, {width, height});
    intake.prepare(lent(PixelFormat::grey, bytes_));
    EXPECT_FALSE(intake.imports());
    EXPECT_NE(intake.reason().find("does not share its buffers"), std::string::npos);
    intake.prepare(lent(PixelFormat::grey, bytes_), "as configured");
    EXPECT_EQ(intake.reason(), "as configured");
    // No dma-buf at all: whatever the driver can, it cannot import this.
    intake.prepare(lent(PixelFormat::grey, bytes_, 0));
    EXPECT_FALSE(intake.imports());
    EXPECT_NE(intake.reason().find("import"), std::string::npos) << intake.reason();
    EXPECT_EQ(intake.counts().copied, 0u) << "a trial is no picture";
}

TEST_F(CameraIntakeTest, RefusesAPictureOfAnotherSize) {
    CameraIntake intake(context_, library_, {width + 2, height});
    EXPECT_NE(thrown_sentence([&] {
                  intake.bring(lent(PixelFormat::grey, bytes_));
              }).find("62x46, and 64x46"),
              std::string::npos);
}

TEST_F(CameraIntakeTest, ImportsBuffersAndSeesWhatIsWrittenIntoThemLater) {
    if (const std::string missing = DmaBufTexture::missing_extensions(context_); !missing.empty())
        GTEST_SKIP() << "SKIPPED: the OpenGL ES driver lacks " << missing;
    const auto memory = SharedMemory::make(picture_bytes);
    if (!memory) GTEST_SKIP() << "SKIPPED: no driver gives this user memory to share (dma-buf)";
    CameraIntake intake(context_, library_, {width, height});
    const auto camera = std::make_shared<int>(0);
    std::uint64_t brought = 0;
    unsigned index = 0;
    for (const PixelFormat format : uncompressed) {
        LentPicture picture = lent(format, memory->bytes(), memory->fd());
        picture.camera = camera;
        picture.index = index++;
        intake.prepare(picture);
        ASSERT_TRUE(intake.imports()) << intake.reason();
        for (const std::uint64_t seed : {7u, 8u}) {
            fill_randomly(memory->bytes(), seed);
            EXPECT_EQ(
                cv::norm(intake.bring(picture).download(), to_colour(picture.raw), cv::NORM_INF), 0)
                << fourcc_text(fourcc_of(format)) << ", filled with " << seed;
        }
        brought = intake.counts().imported;
        EXPECT_EQ(brought, 2u);
    }
    EXPECT_EQ(intake.counts().copied, 0u);
}

TEST(BufferLender, GivesBackWhenTheLastOwnerLetsGo) {
    std::vector<unsigned> back;
    BufferLender lender([&](unsigned index) { back.push_back(index); });
    auto lease = lender.lend(3, nullptr);
    auto second = lease;
    lease.reset();
    EXPECT_TRUE(back.empty());
    second.reset();
    EXPECT_EQ(back, std::vector<unsigned>{3});
}

TEST(BufferLender, KeepsTheMemoryButNotTheDriverBeyondItsEnd) {
    std::vector<unsigned> back;
    auto memory = std::make_shared<int>(1);
    const std::weak_ptr<int> watched = memory;
    std::shared_ptr<const void> lease;
    {
        BufferLender lender([&](unsigned index) { back.push_back(index); });
        lease = lender.lend(0, std::move(memory));
    }
    EXPECT_FALSE(watched.expired());
    lease.reset();
    EXPECT_TRUE(watched.expired());
    EXPECT_TRUE(back.empty()) << "the camera is closed";
}

}  // namespace
}  // namespace vantage
