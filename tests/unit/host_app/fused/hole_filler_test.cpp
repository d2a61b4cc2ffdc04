#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "common/image/image.h"
#include "host_app/surfaces/pull_push.h"
#include "tests/support/filled_texture.h"

namespace vantage {
namespace {

using Picture = cv::Mat_<cv::Vec4d>;  // red, green, blue; 1 where anything is known

/// Half of a picture and its depth: the means of those of four pixels that are known and as far as
/// the farthest, to a twentieth.
void halve(Picture& picture, DepthImage& depth_m) {
    const cv::Size half((picture.cols + 1) / 2, (picture.rows + 1) / 2);
    Picture colours(half, cv::Vec4d::all(0));
    DepthImage depths(half, 0.0f);
    for (int y = 0; y < half.height; ++y)
        for (int x = 0; x < half.width; ++x) {
            std::vector<cv::Point> known;
            double farthest = 0;
            for (int k = 0; k < 4; ++k) {
                const cv::Point p(std::min(2 * x + k % 2, picture.cols - 1),
                                  std::min(2 * y + k / 2, picture.rows - 1));
                if (picture(p)[3] == 0) continue;
                known.push_back(p);
                farthest = std::max(farthest, double{depth_m(p)});
            }
            double count = 0, z = 0;
            for (const cv::Point& p : known)
                if (depth_m(p) >= 0.95 * farthest)
                    colours(y, x) += picture(p), z += depth_m(p), ++count;
            if (count == 0) continue;
            colours(y, x) /= count;
            depths(y, x) = static_cast<float>(z / count);
        }
    picture = colours;
    depth_m = depths;
}

Picture filled_by_halves(const Picture& picture, const DepthImage& depth_m) {
    if (picture.total() == 1) return picture;
    Picture coarse = picture;
    DepthImage coarse_m = depth_m;
    halve(coarse, coarse_m);
    coarse = filled_by_halves(coarse, coarse_m);
    Picture filled = picture.clone();
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols; ++x) {
            if (picture(y, x)[3] > 0) continue;
            // The middle of a fine pixel among the middles of coarse ones.
            const double u = 0.5 * x - 0.25, v = 0.5 * y - 0.25;
            cv::Vec4d sum = cv::Vec4d::all(0);
            for (int k = 0; k < 4; ++k) {
                const int cu = static_cast<int>(std::floor(u)) + k % 2,
                          cv = static_cast<int>(std::floor(v)) + k / 2;
                sum +=
                    (1 - std::abs(u - cu)) * (1 - std::abs(v - cv)) *
                    coarse(std::clamp(cv, 0, coarse.rows - 1), std::clamp(cu, 0, coarse.cols - 1));
            }
            filled(y, x) = sum;
        }
    return filled;
}

class HoleFillerTest : public testing::Test {
  protected:
    ColourImage filled(const ColourImage& picture, const DepthImage& depth_m) {
        const Texture colour = filled_texture(TextureFormat::rgba8, picture);
        const Texture depth = filled_texture(TextureFormat::r32f, depth_m);
        return filler_.fill(colour, depth).download();
    }

    EglContext context_;
    ShaderLibrary shaders_;
    HoleFiller filler_{shaders_};
};

TEST_F(HoleFillerTest, FillsByPullAndPushFromTheFartherSide) {
    ColourImage picture(37, 53, cv::Vec4b(0, 0, 0, 0));
    DepthImage depth_m(picture.size(), 0.0f);
    Picture wanted(picture.size(), cv::Vec4d::all(0));
    cv::RNG random(2);
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols; ++x) {
            const bool is_hole =
                std::hypot(x - 20, y - 15) < 9 || x > 44 || random.uniform(0, 5) == 0;
            if (is_hole) continue;
            // A smooth picture, near and red on one side, far and blue on the other.
            const bool is_near = x < 20;
            picture(y, x) =
                cv::Vec4b(static_cast<uchar>(is_near ? 200 : 20), static_cast<uchar>(3 * x + y),
                          static_cast<uchar>(is_near ? 20 : 200), 255);
            depth_m(y, x) = is_near ? 2.0f : 4.0f;
            for (int c = 0; c < 3; ++c) wanted(y, x)[c] = picture(y, x)[c];
            wanted(y, x)[3] = 1;
        }
    const ColourImage result = filled(picture, depth_m);
    wanted = filled_by_halves(wanted, depth_m);
    int holes = 0;
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols; ++x) {
            if (picture(y, x)[3] > 0) {
                EXPECT_EQ(result(y, x), picture(y, x)) << x << ' ' << y;
                continue;
            }
            ++holes;
            EXPECT_EQ(result(y, x)[3], 64) << x << ' ' << y;
            // Six levels are each rounded to 8 bits.
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(result(y, x)[c], wanted(y, x)[c], 3) << x << ' ' << y;
        }
    EXPECT_GT(holes, 500);
}

TEST_F(HoleFillerTest, KeepsTheAlphaOfWhatIsKnown) {
    ColourImage picture(5, 7, cv::Vec4b(10, 20, 30, 96));
    picture(2, 3) = cv::Vec4b(0, 0, 0, 0);
    const ColourImage result = filled(picture, DepthImage(picture.size(), 1.0f));
    EXPECT_EQ(result(2, 3), cv::Vec4b(10, 20, 30, 64));
    EXPECT_EQ(result(1, 1), picture(1, 1));
}

TEST_F(HoleFillerTest, FillsNothingFromNothing) {
    const ColourImage nothing(19, 30, cv::Vec4b(0, 0, 0, 0));
    const ColourImage result = filled(nothing, DepthImage(nothing.size(), 0.0f));
    EXPECT_EQ(cv::norm(result, cv::NORM_INF), 0);
}

}  // namespace
}  // namespace vantage
