#include "rig_firmware/stereo/features/luma_pass.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/references/stereo/stream_average.h"
#include "tests/unit/rig_firmware/stereo/engine_buffers.h"

namespace vantage {
namespace {

/// A plane of LumaPass's buffers without the words around its rows.
GreyImage plane_of(const Buffer& buffer, const StereoLayout& layout, int plane) {
    std::vector<unsigned char> bytes(buffer.bytes());
    buffer.read(0, std::as_writable_bytes(std::span(bytes)));
    GreyImage picture(layout.height_px, layout.width_px);
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols; ++x)
            picture(y, x) = bytes[static_cast<std::size_t>(
                ((plane * layout.height_px + y) * layout.luma_row_words() + 1) * 4 + x)];
    return picture;
}

class LumaPassTest : public EnginePassTest {
  protected:
    Texture left_texture_{TextureFormat::rgba8, layout_.width_px, layout_.height_px},
        right_texture_{TextureFormat::rgba8, layout_.width_px, layout_.height_px};
};

TEST_P(LumaPassTest, AveragesAStreamAsItsCpuFormDoesBitForBit) {
    LumaPass pass(library_, layout_, PictureKind::of_stream);
    StreamAverage left_average, right_average;
    cv::RNG random(4);
    for (int frame = 0; frame < 9; ++frame) {
        for (ColourImage* picture : {&pair_.left, &pair_.right})
            for (cv::Vec4b& pixel : *picture)
                for (int c = 0; c < 3; ++c) {
                    const int most = random.uniform(0, 8) == 0 ? 60 : 9;
                    pixel[c] = cv::saturate_cast<unsigned char>(pixel[c] +
                                                                random.uniform(-most, most + 1));
                }
        left_texture_.upload(pair_.left);
        right_texture_.upload(pair_.right);
        pass.run(profiler_, left_texture_, right_texture_);
        const StereoPlanes left = left_average.run(pair_.left),
                           right = right_average.run(pair_.right);
        expect_equal(as_int(plane_of(pass.left(), layout_, 0)), as_int(left.luma), "left luma");
        expect_equal(as_int(plane_of(pass.left(), layout_, 1)), as_int(left.colour), "left colour");
        expect_equal(as_int(plane_of(pass.right(), layout_, 0)), as_int(right.luma), "right luma");
        expect_equal(as_int(plane_of(pass.right(), layout_, 1)), as_int(right.colour),
                     "right colour");
    }
}

TEST_P(LumaPassTest, LeavesPicturesByThemselvesAsTheyAre) {
    LumaPass pass(library_, layout_);
    for (const int level : {100, 103}) {
        const cv::Vec4b grey(static_cast<unsigned char>(level), static_cast<unsigned char>(level),
                             static_cast<unsigned char>(level), 255);
        const ColourImage picture(layout_.height_px, layout_.width_px, grey);
        left_texture_.upload(picture);
        right_texture_.upload(picture);
        pass.run(profiler_, left_texture_, right_texture_);
        EXPECT_EQ(plane_of(pass.left(), layout_, 0)(0, 0), level);
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, LumaPassTest,
                         testing::Values(PassCase{64, 48, 16}, PassCase{131, 77, 40},
                                         PassCase{37, 1, 9}, PassCase{1, 23, 4}),
                         [](const auto& test) {
                             return std::to_string(test.param.width) + "x" +
                                    std::to_string(test.param.height);
                         });

TEST(StreamAverage, LeavesAThirdOfTheNoiseOfWhatStandsStillAndFollowsWhatChangesAtOnce) {
    StreamAverage average;
    cv::RNG random(5);
    double squares = 0;
    constexpr int frames = 60, side = 40, settling = 20;
    for (int frame = 0; frame < frames; ++frame) {
        ColourImage picture(side, side);
        for (cv::Vec4b& pixel : picture) {
            const auto level = cv::saturate_cast<unsigned char>(120 + random.gaussian(2));
            pixel = {level, level, level, 255};
        }
        const GreyImage luma = average.run(picture).luma;
        if (frame < settling) continue;
        for (const unsigned char level : luma) squares += (level - 120.0) * (level - 120.0);
    }
    EXPECT_LE(std::sqrt(squares / ((frames - settling) * side * side)), 2.0 / 2.5);
    const ColourImage other(side, side, cv::Vec4b(150, 150, 150, 255));
    EXPECT_EQ(cv::countNonZero(average.run(other).luma == 150), side * side);
}

}  // namespace
}  // namespace vantage
