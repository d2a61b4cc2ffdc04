#include "host_app/background/still_image.h"

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "common/wire/codec/colour_codec.h"
#include "host_app/surfaces/rig_history.h"

namespace vantage {
namespace {

const cv::Size right_size{32, 24};
const cv::Vec4b wall_colour(90, 120, 60, 255), coat_colour(200, 30, 40, 255);

/// A wall, part of it hidden by a person.
SharedBytes right_seen(const cv::Rect& somebody = {}) {
    ColourImage picture(right_size, wall_colour);
    picture(somebody) = coat_colour;
    return std::make_shared<const std::vector<std::byte>>(
        JpegEncoder().encode(picture, 95, Chroma::full));
}

double furthest_off(const ColourImage& still) {
    return cv::norm(still, ColourImage(right_size, wall_colour), cv::NORM_INF);
}

TEST(StillImage, LeavesOutAPersonWhoPassesBy) {
    const std::vector<SharedBytes> passing{right_seen({0, 0, 8, 24}), right_seen({8, 0, 8, 24}),
                                           right_seen({16, 0, 8, 24}), right_seen({24, 0, 8, 24})};
    EXPECT_LE(furthest_off(still_picture(passing, right_size)), 2);
    const std::vector<SharedBytes> standing(4, right_seen({0, 0, 8, 24}));
    EXPECT_GT(furthest_off(still_picture(standing, right_size)), 80);
}

TEST(StillImage, NeedsThreeIntactImages) {
    const std::vector<SharedBytes> two{right_seen(), right_seen()};
    EXPECT_TRUE(still_picture(two, right_size).empty());
    std::vector<std::byte> torn = *right_seen();
    torn.resize(torn.size() / 2);
    std::vector<SharedBytes> some{
        right_seen(), std::make_shared<const std::vector<std::byte>>(torn), right_seen()};
    EXPECT_TRUE(still_picture(some, right_size).empty());
    some.push_back(right_seen());
    EXPECT_LE(furthest_off(still_picture(some, right_size)), 2);
    EXPECT_TRUE(still_picture(some, {16, 24}).empty()) << "the images have another size";
}

class RightImagesOfARigTest : public testing::Test {
  protected:
    DepthView view(const SharedBytes& right) const {
        DepthView view;
        view.name = "rig";
        view.colour = ColourImage(right_size, wall_colour);
        view.K << 30, 0, 16, 0, 30, 12, 0, 0, 1;
        view.depth_m = DepthImage(right_size, 3.0f);
        view.baseline_m = 0.1;
        view.right_jpeg = right;
        return view;
    }
    EglContext context_;
    RigHistory rig_;
};

TEST_F(RightImagesOfARigTest, AreTheNewestWithoutRepetition) {
    std::vector<SharedBytes> came;
    for (int i = 0; i < 20; ++i) {
        came.push_back(right_seen());
        for (int frame = 0; frame < 3; ++frame) rig_.upload(view(came.back()));
        rig_.upload(view(nullptr));
    }
    ASSERT_EQ(rig_.right_jpegs().size(), 16u);
    EXPECT_EQ(rig_.right_jpegs().front(), came[4]);
    EXPECT_EQ(rig_.right_jpegs().back(), came[19]);
}

TEST_F(RightImagesOfARigTest, AreForgottenWithTheBackgroundAndWithTheCamera) {
    rig_.upload(view(right_seen()));
    rig_.upload(view(right_seen()));
    rig_.forget();
    EXPECT_TRUE(rig_.right_jpegs().empty());
    rig_.upload(view(right_seen()));
    DepthView moved = view(right_seen());
    moved.world_from_camera.translation().x() = 1;
    rig_.upload(moved);
    ASSERT_EQ(rig_.right_jpegs().size(), 1u);
    EXPECT_EQ(rig_.right_jpegs().front(), moved.right_jpeg);
}

}  // namespace
}  // namespace vantage
