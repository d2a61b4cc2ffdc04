#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/gl/egl_context.h"
#include "common/image/image.h"
#include "tests/unit/instants/drawn_by.h"

namespace vantage {
namespace {

constexpr int width_px = 67, height_px = 45;
// The kinds of set_kinds.glsl.
constexpr uchar the_set = 0, lit_set = 64, untold = 112, new_set = 152, uncovered = 192,
                before_set = 255;

/// Patches of a few colours and kinds, so that every kind has neighbours of every other.
class MatteTest : public testing::Test {
  protected:
    MatteTest() {
        cv::RNG random(7);
        const uchar kinds[] = {the_set, lit_set,   untold,     untold,
                               new_set, uncovered, before_set, before_set};
        for (int v = 0; v < height_px; ++v)
            for (int u = 0; u < width_px; ++u) {
                const int patch = (u / 7) * 5 + (v / 6) * 3;
                // One pixel in five is of another kind than its patch.
                const int kind = random.uniform(0, 5) == 0 ? random.uniform(0, 8) : patch % 8;
                seen_(v, u) = {kinds[kind], 0, static_cast<uchar>(random.uniform(0, 24)), 255};
                for (int c = 0; c < 3; ++c)
                    picture_(v, u)[c] =
                        static_cast<uchar>(90 + 20 * ((patch / 3 + c) % 3) + random.uniform(0, 6));
            }
    }
    cv::Mat1b drawn() {
        FullscreenPass pass(shaders_, "matte.frag");
        const Texture picture = texture_of(TextureFormat::rgba8, picture_);
        const Texture seen = texture_of(TextureFormat::rgba8, seen_);
        const Texture target(TextureFormat::r8, width_px, height_px);
        Program& program = pass.use();
        program.set("picture", 0);
        program.set("seen", 1);
        picture.bind(0);
        seen.bind(1);
        cv::Mat1b matte;
        cv::extractChannel(drawn_by(pass, target), matte, 0);
        return matte;
    }
    /// Twenty-five pixels, two apart, tell; by how much what decided was over or under.
    bool is_performer(int u, int v, double& margin) const {
        int before = 0, count = 0;
        double like_before = 0, like_set = 0;
        for (int y = -2; y <= 2; ++y)
            for (int x = -2; x <= 2; ++x) {
                const uchar kind = clamped(seen_, u + 2 * x, v + 2 * y)[0];
                const cv::Vec4b& colour = clamped(picture_, u + 2 * x, v + 2 * y);
                double off = 0;
                for (int c = 0; c < 3; ++c) off += std::abs(colour[c] - picture_(v, u)[c]) / 255.0;
                const double weight = std::exp(-off / (3 * 0.05)) + 1e-3;
                const bool is_before = kind == before_set;
                const bool is_set = !is_before && kind != untold && kind != uncovered;
                before += is_before ? 1 : 0;
                count += is_before || is_set ? 1 : 0;
                like_before += is_before ? weight : 0;
                like_set += is_set ? weight : 0;
            }
        margin = 1;
        const uchar own = seen_(v, u)[0];
        if (own == uncovered) return true;
        if (before == 0) return false;
        const double around = static_cast<double>(before) / count;
        if (own != before_set && own != untold) {
            margin = std::abs(around - 0.8);
            return around > 0.8;
        }
        margin = std::min(std::abs(like_before - like_set), std::abs(around - 0.15));
        const bool is_like_before = like_before > like_set;
        if (own == untold) return is_like_before;
        return around > 0.15 && (seen_(v, u)[2] / 255.0 > 0.04 || is_like_before);
    }

    EglContext context_;
    ShaderLibrary shaders_;
    ColourImage picture_ = ColourImage(height_px, width_px, cv::Vec4b(0, 0, 0, 255));
    ColourImage seen_ = picture_.clone();
};

TEST_F(MatteTest, IsTheReferences) {
    const cv::Mat1b matte = drawn();
    int performers = 0, judged = 0;
    for (int v = 0; v < height_px; ++v)
        for (int u = 0; u < width_px; ++u) {
            double margin = 0;
            const bool expected = is_performer(u, v, margin);
            // A share that is the threshold itself falls to either side with the last bit.
            if (margin < 1e-5) continue;
            ++judged;
            performers += expected ? 1 : 0;
            ASSERT_EQ(matte(v, u), expected ? 255 : 0)
                << u << ' ' << v << ", kind " << int(seen_(v, u)[0]);
        }
    EXPECT_GT(judged, 0.95 * width_px * height_px);
    EXPECT_GT(performers, judged / 10);
    EXPECT_LT(performers, judged * 9 / 10);
}

TEST_F(MatteTest, IsEmptyWhereNothingIsBeforeTheSet) {
    for (cv::Vec4b& seen : seen_)
        if (seen[0] == before_set || seen[0] == uncovered) seen[0] = untold;
    EXPECT_EQ(cv::countNonZero(drawn()), 0);
}

TEST_F(MatteTest, IsSoftenedByABinomialFilter) {
    cv::Mat1b hard(height_px, width_px);
    cv::RNG random(3);
    for (int v = 0; v < height_px; ++v)
        for (int u = 0; u < width_px; ++u)
            hard(v, u) = (u / 9 + v / 8) % 2 == 0 || random.uniform(0, 30) == 0 ? 255 : 0;
    FullscreenPass pass(shaders_, "matte_soften.frag");
    const Texture given = texture_of(TextureFormat::r8, hard, Filter::linear);
    const Texture target(TextureFormat::r8, width_px, height_px);
    pass.use().set("hard", 0);
    given.bind(0);
    cv::Mat1b soft;
    cv::extractChannel(drawn_by(pass, target), soft, 0);

    cv::Mat1f share;
    hard.convertTo(share, CV_32F, 1 / 255.0);
    const cv::Mat1f weights = (cv::Mat1f(1, 3) << 0.25f, 0.5f, 0.25f);
    cv::sepFilter2D(share, share, CV_32F, weights, weights, {-1, -1}, 0, cv::BORDER_REPLICATE);
    for (int v = 0; v < height_px; ++v)
        for (int u = 0; u < width_px; ++u) {
            const double expected = std::clamp((share(v, u) - 0.1) / 0.8, 0.0, 1.0);
            // Samplers of 8 bit pictures may round to 8 bits: four times half a level, over 0.8.
            ASSERT_NEAR(soft(v, u), 255 * expected, 1.5) << u << ' ' << v;
        }
}

}  // namespace
}  // namespace vantage
