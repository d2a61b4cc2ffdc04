#include <bit>
#include <limits>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "host_app/surfaces/rig_surface.h"

namespace vantage {
namespace {

/// The CPU reference.
DepthImage converted(const DisparityImage& disparity, const RectifiedStereo& geometry) {
    DepthImage depth_m(disparity.size());
    const auto px_per_step =
        static_cast<float>(static_cast<double>(geometry.width_px) /
                           (static_cast<double>(disparity.cols) * disparity_steps_per_px));
    const auto doffs_px = static_cast<float>(geometry.doffs_px());
    const auto f_baseline = static_cast<float>(geometry.f_px * geometry.baseline_m);
    for (int y = 0; y < disparity.rows; ++y)
        for (int x = 0; x < disparity.cols; ++x) {
            const float d = static_cast<float>(disparity(y, x)) * px_per_step + doffs_px;
            depth_m(y, x) =
                f_baseline /
                (disparity(y, x) != 0 && d > 0 ? d : std::numeric_limits<float>::infinity());
        }
    return depth_m;
}

class DepthUploaderTest : public testing::Test {
  protected:
    static RectifiedStereo geometry(double doffs_px) {
        RectifiedStereo g;
        g.width_px = 962;
        g.height_px = 722;
        g.f_px = 913.7;
        g.cx_left_px = 480;
        g.cx_right_px = 480 + doffs_px;
        g.baseline_m = 0.1237;
        return g;
    }
    DepthImage uploaded(const DisparityImage& disparity, const RectifiedStereo& geometry) {
        DepthView view;
        view.disparity = disparity;
        view.disparity_scale = DisparityScale(geometry, disparity.cols);
        upload_depth(view, uploader_, depth_);
        return depth_.texture().download();
    }
    static int differing(const DepthImage& a, const DepthImage& b) {
        EXPECT_EQ(a.size(), b.size());
        int count = 0;
        for (int y = 0; y < a.rows; ++y)
            for (int x = 0; x < a.cols; ++x)
                count +=
                    std::bit_cast<std::uint32_t>(a(y, x)) != std::bit_cast<std::uint32_t>(b(y, x));
        return count;
    }

    EglContext context_;
    std::unique_ptr<DepthUploader> uploader_;
    DrawnTexture depth_{TextureFormat::r32f};
};

TEST_F(DepthUploaderTest, MatchesTheCpuBitForBitForEveryDisparity) {
    // 481 columns: half of the geometry's, and rows that are not a multiple of four bytes.
    DisparityImage all(137, 481);
    for (int i = 0; i < all.rows * all.cols; ++i)
        all(i / all.cols, i % all.cols) = static_cast<std::uint16_t>(std::min(i, 65535));
    for (const double doffs_px : {0.0, -37.25, 12.5})
        EXPECT_EQ(differing(uploaded(all, geometry(doffs_px)), converted(all, geometry(doffs_px))),
                  0)
            << doffs_px;
}

TEST_F(DepthUploaderTest, KeepsTheGeometriesOfSeveralRigsApart) {
    const DisparityImage some(31, 33, static_cast<std::uint16_t>(1234));
    for (const double doffs_px : {0.0, 5.0, 0.0})
        EXPECT_EQ(
            differing(uploaded(some, geometry(doffs_px)), converted(some, geometry(doffs_px))), 0)
            << doffs_px;
}

TEST_F(DepthUploaderTest, UploadsAPartOfALargerMap) {
    DisparityImage large(40, 50);
    for (int i = 0; i < 2000; ++i) large(i / 50, i % 50) = static_cast<std::uint16_t>(30 * i);
    const DisparityImage part = large(cv::Rect(7, 5, 23, 11));
    EXPECT_EQ(differing(uploaded(part, geometry(0)), converted(part, geometry(0))), 0);
}

TEST_F(DepthUploaderTest, UploadsMetresUnchanged) {
    DepthView view;
    view.depth_m = DepthImage(5, 7, 1.25f);
    upload_depth(view, uploader_, depth_);
    EXPECT_EQ(differing(depth_.texture().download(), view.depth_m), 0);
}

}  // namespace
}  // namespace vantage
