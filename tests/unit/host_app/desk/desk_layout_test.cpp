#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>

#include "host_app/desk/desk_arrangement.h"

namespace vantage {
namespace {

struct Size {
    float width, height;
};
constexpr Size sizes[] = {{640, 360},   {960, 540},   {1280, 720}, {1280, 1024},
                          {1920, 1080}, {2560, 1080}, {3840, 2160}};
constexpr float wide = 9.0f / 16;

DeskLayout layout_of(Size size, int rigs = 4, float aspect = wide, bool has_clips = false,
                     bool has_preview = false) {
    return desk_layout(size.width, size.height, letter_height_px(size.width, size.height, 1), rigs,
                       aspect, has_clips, has_preview);
}
std::vector<DeskRect> parts_of(const DeskLayout& layout) {
    return {layout.status, layout.programme, layout.preview,   layout.shots,
            layout.clips,  layout.side,      layout.time_line, layout.rigs};
}
bool overlap(const DeskRect& a, const DeskRect& b) {
    constexpr float slack = 0.5f;
    return a.left + slack < b.right() && b.left + slack < a.right() && a.top + slack < b.bottom() &&
           b.top + slack < a.bottom();
}

TEST(DeskLayoutTest, PartsAreInTheWindowAndDoNotOverlap) {
    for (const Size size : sizes)
        for (const int rigs : {0, 1, 2, -2, 4, 9, -9, 16, 104, -102}) {
            const bool has_preview = std::abs(rigs) > 100;
            const std::vector<DeskRect> parts =
                parts_of(layout_of(size, std::abs(rigs) % 100, wide, rigs < 0, has_preview));
            for (std::size_t i = 0; i < parts.size(); ++i) {
                if (parts[i].is_empty()) continue;
                EXPECT_GE(parts[i].left, -0.5f) << size.width << " part " << i;
                EXPECT_GE(parts[i].top, -0.5f) << size.width << " part " << i;
                EXPECT_LE(parts[i].right(), size.width + 0.5f) << size.width << " part " << i;
                EXPECT_LE(parts[i].bottom(), size.height + 0.5f) << size.width << " part " << i;
                for (std::size_t j = 0; j < i; ++j)
                    EXPECT_FALSE(!parts[j].is_empty() && overlap(parts[i], parts[j]))
                        << size.width << "x" << size.height << " of " << rigs << " rigs: " << i
                        << " and " << j;
            }
        }
}

TEST(DeskLayoutTest, ThePictureIsTheLargestPart) {
    for (const Size size : sizes) {
        const DeskLayout layout = layout_of(size);
        const DeskRect picture = layout.programme.fitted(wide);
        EXPECT_GT(picture.width, 0.49f * size.width) << size.width;
        for (const DeskRect& part : {layout.side, layout.shots, layout.rigs, layout.time_line})
            EXPECT_GT(picture.width * picture.height, part.width * part.height) << size.width;
    }
}

TEST(DeskLayoutTest, AllPartsExistFromTheSmallestDocumentedSizeOn) {
    for (const Size size : sizes)
        for (const DeskRect& part : parts_of(layout_of(size, 4, wide, true, true)))
            EXPECT_FALSE(part.is_empty()) << size.width << "x" << size.height;
}

TEST(DeskLayoutTest, ASmallWindowKeepsPictureStatusAndTimeLine) {
    const DeskLayout layout = layout_of({320, 240});
    EXPECT_TRUE(layout.side.is_empty());
    EXPECT_TRUE(layout.shots.is_empty());
    EXPECT_TRUE(layout.rigs.is_empty());
    EXPECT_FALSE(layout.status.is_empty());
    EXPECT_FALSE(layout.time_line.is_empty());
    EXPECT_GT(layout.programme.height, 120);
}

TEST(DeskLayoutTest, LettersScaleWithTheWindowAndTheDisplayAndStayReadable) {
    EXPECT_EQ(letter_height_px(1920, 1080, 1), 20);
    EXPECT_EQ(letter_height_px(3840, 2160, 1), 40);
    EXPECT_EQ(letter_height_px(640, 360, 1), 9);
    EXPECT_EQ(letter_height_px(640, 360, 2), 18);
    EXPECT_LT(letter_height_px(800, 2160, 1), 10) << "a narrow window has room for few letters";
}

TEST(DeskLayoutTest, ClipsHaveABinBesideTheShotsIfThereAreAny) {
    const DeskLayout without = layout_of({1280, 720}), with = layout_of({1280, 720}, 4, wide, true);
    EXPECT_TRUE(without.clips.is_empty());
    EXPECT_EQ(with.clips.width, with.shots.width);
    EXPECT_GT(with.clips.left, with.shots.right());
    EXPECT_GT(with.programme.width, 0.5f * 1280);
    EXPECT_TRUE(layout_of({640, 360}, 4, wide, true).clips.is_empty() ||
                !layout_of({640, 360}).shots.is_empty());
}

TEST(DeskLayoutTest, APreviewIsLargeAndTheProgrammeIsLarger) {
    for (const Size size : sizes) {
        const DeskLayout layout = layout_of(size, 4, wide, false, true);
        const DeskRect programme = layout.programme.fitted(wide);
        const DeskRect preview = layout.preview.fitted(wide);
        EXPECT_GE(programme.width, preview.width) << size.width;
        EXPECT_GT(preview.width, 0.26f * size.width) << size.width;
        EXPECT_GT(layout.side.height, 4 * letter_height_px(size.width, size.height, 1));
    }
    const DeskLayout small = layout_of({320, 240}, 4, wide, false, true);
    EXPECT_FLOAT_EQ(small.programme.width, small.preview.width);
    EXPECT_LT(small.preview.right(), small.programme.left);
    const DeskLayout alone = pictures_alone(1280, 720, true);
    EXPECT_FLOAT_EQ(alone.programme.width, 640);
    EXPECT_TRUE(pictures_alone(1280, 720, false).preview.is_empty());
}

TEST(DeskLayoutTest, ManyRigsAreInRows) {
    EXPECT_EQ(layout_of({1280, 720}, 4).rig_rows, 1);
    EXPECT_GT(layout_of({1280, 720}, 12).rig_rows, 1);
}

TEST(DeskLayoutTest, RigsFillTheirOwnWindow) {
    EXPECT_EQ(best_rig_rows(1280, 720, 13, 1), 1);
    EXPECT_EQ(best_rig_rows(1280, 720, 13, 4), 2);
    EXPECT_EQ(best_rig_rows(2560, 360, 9, 4), 1);
    EXPECT_EQ(best_rig_rows(720, 1280, 13, 4), 4);
}

TEST(DeskRectTest, FitsTheLargestPictureOfAShapeIntoItsMiddle) {
    const DeskRect square = DeskRect{10, 20, 200, 100}.fitted(1);
    EXPECT_EQ(square.left, 60);
    EXPECT_EQ(square.top, 20);
    EXPECT_EQ(square.width, 100);
    EXPECT_EQ(square.height, 100);
}

}  // namespace
}  // namespace vantage
