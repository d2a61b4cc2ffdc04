#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/gl/context/egl_context.h"
#include "common/image/image.h"
#include "tests/unit/host_app/background/background_kinds.h"
#include "tests/unit/host_app/surfaces/drawn_by.h"

namespace vantage {
namespace {

constexpr int matte_width_px = 67, matte_height_px = 45;

/// Patches of a few colours and kinds, so that every kind borders on every other.
class MatteTest : public testing::Test {
  protected:
    MatteTest() {
        cv::RNG random(7);
        const uchar kinds[] = {the_background,    lit_background,   undecided,
                               undecided,         new_background,   uncovered,
                               before_background, before_background};
        for (int v = 0; v < matte_height_px; ++v)
            for (int u = 0; u < matte_width_px; ++u) {
                const int patch = (u / 7) * 5 + (v / 6) * 3;
                // One pixel in five is of another kind than its patch.
                const int kind = random.uniform(0, 5) == 0 ? random.uniform(0, 8) : patch % 8;
                seen_(v, u) = {kinds[kind], 0, static_cast<uchar>(random.uniform(0, 24)), 255};
                for (int c = 0; c < 3; ++c)
                    picture_(v, u)[c] =
                        static_cast<uchar>(90 + 20 * ((patch / 3 + c) % 3) + random.uniform(0, 6));
            }
        for (uchar& share : enclosed_) share = static_cast<uchar>(random.uniform(0, 256));
    }
    cv::Mat1b drawn() {
        FullscreenPass pass(shaders_, "matte.frag");
        const Texture picture = texture_of(TextureFormat::rgba8, picture_);
        const Texture seen = texture_of(TextureFormat::rgba8, seen_);
        const Texture enclosed = texture_of(TextureFormat::r8, enclosed_);
        const Texture target(TextureFormat::r8, matte_width_px, matte_height_px);
        Program& program = pass.use();
        program.input("picture", picture);
        program.input("seen", seen);
        program.input("enclosed", enclosed);
        cv::Mat1b matte;
        cv::extractChannel(drawn_by(pass, target), matte, 0);
        return matte;
    }
    /// The result of matte_edges.frag for a hard matte.
    cv::Mat1b softened(const cv::Mat1b& hard, const ColourImage& picture,
                       const ColourImage& background) {
        FullscreenPass pass(shaders_, "matte_edges.frag");
        const Texture given = texture_of(TextureFormat::r8, hard, Filter::linear);
        const Texture seen = texture_of(TextureFormat::rgba8, picture, Filter::linear);
        const Texture behind = texture_of(TextureFormat::rgba8, background, Filter::linear);
        const Texture target(TextureFormat::r8, hard.cols, hard.rows);
        Program& program = pass.use();
        program.input("hard", given);
        program.input("picture", seen);
        program.input("background_colour", behind);
        cv::Mat1b soft;
        cv::extractChannel(drawn_by(pass, target), soft, 0);
        return soft;
    }
    /// The reference: decides from twenty-five pixels, two apart; `margin` is the distance from the
    /// threshold that decided.
    bool is_foreground(int u, int v, double& margin) const {
        int before = 0, count = 0;
        double like_before = 0, like_background = 0;
        for (int y = -2; y <= 2; ++y)
            for (int x = -2; x <= 2; ++x) {
                const uchar kind = clamped(seen_, u + 2 * x, v + 2 * y)[0];
                const cv::Vec4b& colour = clamped(picture_, u + 2 * x, v + 2 * y);
                double off = 0;
                for (int c = 0; c < 3; ++c) off += std::abs(colour[c] - picture_(v, u)[c]) / 255.0;
                const double weight = std::exp(-off / (3 * 0.05)) + 1e-3;
                const bool is_before = kind == before_background;
                const bool is_set = !is_before && kind != undecided && kind != uncovered;
                before += is_before ? 1 : 0;
                count += is_before || is_set ? 1 : 0;
                like_before += is_before ? weight : 0;
                like_background += is_set && kind != new_background ? weight : 0;
            }
        margin = 1;
        const uchar own = seen_(v, u)[0];
        if (own == uncovered) return true;
        const double region =
            enclosed_(v * enclosed_.rows / matte_height_px, u * enclosed_.cols / matte_width_px) /
            255.0;
        if (before == 0 && region < 0.5) return false;
        like_before += 2 * region;
        like_background += 2 * (1 - region);
        const double around = static_cast<double>(before) / std::max(count, 1);
        if (own == new_background) {
            margin = std::min(std::abs(like_before - like_background), std::abs(around - 0.4));
            return around > 0.4 && like_before > like_background;
        }
        if (own != before_background && own != undecided) {
            margin = std::abs(around - 0.8);
            return around > 0.8 || region >= (own == lit_background ? 0.7 : 0.95);
        }
        margin = std::min(std::abs(like_before - like_background), std::abs(around - 0.15));
        const bool is_like_before = like_before > like_background;
        if (own == undecided) return is_like_before;
        return around > 0.15 && (seen_(v, u)[2] / 255.0 > 0.04 || is_like_before);
    }

    EglContext context_;
    ShaderLibrary shaders_;
    ColourImage picture_ = ColourImage(matte_height_px, matte_width_px, cv::Vec4b(0, 0, 0, 255));
    ColourImage seen_ = picture_.clone();
    /// As matte_region.frag draws it, at an exact fraction of the size.
    cv::Mat1b enclosed_{9, 67};
};

TEST_F(MatteTest, MatchesTheReference) {
    const cv::Mat1b matte = drawn();
    int performers = 0, judged = 0;
    for (int v = 0; v < matte_height_px; ++v)
        for (int u = 0; u < matte_width_px; ++u) {
            double margin = 0;
            const bool expected = is_foreground(u, v, margin);
            // At the threshold, rounding decides.
            if (margin < 1e-5) continue;
            ++judged;
            performers += expected ? 1 : 0;
            ASSERT_EQ(matte(v, u), expected ? 255 : 0)
                << u << ' ' << v << ", kind " << int(seen_(v, u)[0]);
        }
    EXPECT_GT(judged, 0.95 * matte_width_px * matte_height_px);
    EXPECT_GT(performers, judged / 10);
    EXPECT_LT(performers, judged * 9 / 10);
}

TEST_F(MatteTest, IsEmptyWithoutForeground) {
    for (cv::Vec4b& seen : seen_)
        if (seen[0] == before_background || seen[0] == uncovered) seen[0] = undecided;
    enclosed_.setTo(0);
    EXPECT_EQ(cv::countNonZero(drawn()), 0);
}

/// A disc of one colour before a background of another, slightly blurred as by a lens.
TEST_F(MatteTest, IsExactAtEdgesBeforeAKnownBackground) {
    const cv::Size size(matte_width_px, matte_height_px);
    constexpr int finer = 8;
    cv::Mat1f true_share(size.height * finer, size.width * finer, 0.0f);
    cv::circle(true_share, {finer * 33, finer * 22}, finer * 15, cv::Scalar(1), cv::FILLED);
    cv::resize(true_share, true_share, size, 0, 0, cv::INTER_AREA);
    const cv::Vec3d red(200, 60, 40), green(40, 150, 90);
    ColourImage background(size, cv::Vec4b(40, 150, 90, 255)), picture(size);
    for (int v = 0; v < size.height; ++v)
        for (int u = 0; u < size.width; ++u) {
            const double share = true_share(v, u);
            const cv::Vec3d mixed = share * red + (1 - share) * green;
            picture(v, u) =
                cv::Vec4b(cv::saturate_cast<uchar>(mixed[0]), cv::saturate_cast<uchar>(mixed[1]),
                          cv::saturate_cast<uchar>(mixed[2]), 255);
        }
    const cv::Mat1b right = true_share > 0.5f;
    cv::Mat1b wide, narrow;
    cv::dilate(right, wide, cv::Mat1b::ones(3, 3));
    cv::erode(right, narrow, cv::Mat1b::ones(3, 3));
    const auto off = [&](const cv::Mat1b& hard, const ColourImage& behind) {
        cv::Mat1f share;
        softened(hard, picture, behind).convertTo(share, CV_32F, 1 / 255.0);
        return cv::norm(share, true_share, cv::NORM_L1) / cv::countNonZero(wide & ~narrow);
    };
    // The error of a hard edge that is a pixel off where the colours are equal.
    EXPECT_GT(off(wide, picture), 0.15);
    for (const cv::Mat1b& hard : {right, wide, narrow}) EXPECT_LT(off(hard, background), 0.08);
}

/// If background and foreground have one colour, a hard edge becomes as soft as lens and sensor
/// make it.
TEST_F(MatteTest, IsSmoothBetweenEqualColours) {
    cv::Mat1b hard(matte_height_px, matte_width_px);
    cv::RNG random(3);
    for (int v = 0; v < matte_height_px; ++v)
        for (int u = 0; u < matte_width_px; ++u)
            hard(v, u) = (u / 9 + v / 8) % 2 == 0 || random.uniform(0, 30) == 0 ? 255 : 0;
    const ColourImage grey(hard.size(), cv::Vec4b(90, 90, 90, 255));
    const cv::Mat1b soft = softened(hard, grey, grey);
    cv::Mat1f share, close, around;
    hard.convertTo(share, CV_32F, 1 / 255.0);
    const auto filtered = [&](cv::Mat1f& into, const cv::Mat1f& weights) {
        cv::sepFilter2D(share, into, CV_32F, weights, weights, {-1, -1}, 0, cv::BORDER_REPLICATE);
    };
    filtered(close, (cv::Mat1f(1, 3) << 0.25f, 0.5f, 0.25f));
    filtered(around, (cv::Mat1f(1, 5) << 0.25f, 0.25f, 0, 0.25f, 0.25f));
    for (int v = 0; v < matte_height_px; ++v)
        for (int u = 0; u < matte_width_px; ++u) {
            const double x =
                std::clamp((0.6 * close(v, u) + 0.4 * around(v, u) - 0.2) / 0.6, 0.0, 1.0);
            // Samplers of 8 bit pictures may round to 8 bits: half a level, over 0.6, by a slope
            // of 1.5.
            ASSERT_NEAR(soft(v, u), 255 * x * x * (3 - 2 * x), 2) << u << ' ' << v;
        }
}

}  // namespace
}  // namespace vantage
