#include <cstdlib>
#include <set>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "common/image/image_file.h"
#include "host_app/desk/panels/desk_parts.h"
#include "host_app/desk/windows/ui_renderer.h"
#include "tests/unit/host_app/desk/example_desk.h"

namespace vantage {
namespace {

const cv::Size usual{1280, 720};

class DeskScreen : public testing::Test {
  protected:
    ColourImage draw(cv::Size size = usual) {
        const auto width = static_cast<float>(size.width), height = static_cast<float>(size.height);
        ui_.set_letter_px(letter_height_px(width, height, 1));
        renderer_.take_fonts();
        ImGui::GetIO().DisplaySize = {width, height};
        const Texture screen(TextureFormat::rgba8, size.width, size.height);
        const Framebuffer target({&screen});
        ImGui::NewFrame();
        drawn_ = draw_desk(state(), switches_, ui_.fonts());
        ImGui::Render();
        renderer_.draw(*ImGui::GetDrawData(), target);
        ColourImage picture = screen.download();
        // For a review of the picture.
        if (const char* file = std::getenv("VANTAGE_TEST_PICTURE"))
            write_colour_image(file, picture);
        return picture;
    }
    DeskState& state() { return desk_.state; }
    DeskLayout layout(cv::Size size = usual) const {
        const auto width = static_cast<float>(size.width), height = static_cast<float>(size.height);
        return desk_layout(width, height, letter_height_px(width, height, 1),
                           static_cast<int>(desk_.state.rigs.size()), 9.0f / 16,
                           !desk_.state.replay.clips.empty(), desk_.state.preview.has_value());
    }
    static cv::Rect pixels(const DeskRect& rect) {
        return {cvCeil(rect.left), cvCeil(rect.top), cvFloor(rect.width) - 1,
                cvFloor(rect.height) - 1};
    }
    static cv::Vec3b at(const ColourImage& screen, float x, float y) {
        const cv::Vec4b& pixel = screen(cvRound(y), cvRound(x));
        return {pixel[0], pixel[1], pixel[2]};
    }
    static int differing(const ColourImage& a, const ColourImage& b, const DeskRect& region) {
        ColourImage difference;
        cv::absdiff(a(pixels(region)), b(pixels(region)), difference);
        int count = 0;
        for (const cv::Vec4b& d : difference) count += d[0] + d[1] + d[2] > 60;
        return count;
    }
    static int of_colour(const ColourImage& screen, const DeskRect& region, const cv::Vec3b& rgb) {
        int count = 0;
        for (const cv::Vec4b& p : ColourImage(screen(pixels(region))))
            count +=
                std::abs(p[0] - rgb[0]) + std::abs(p[1] - rgb[1]) + std::abs(p[2] - rgb[2]) < 9;
        return count;
    }

    EglContext context_;
    ShaderLibrary shaders_;
    UiContext ui_{13};
    UiRenderer renderer_{shaders_};
    ExampleDesk desk_;
    DeskSwitches switches_;
    DrawnDesk drawn_;
};

TEST_F(DeskScreen, CoversNoPartOfThePicture) {
    for (const cv::Size size : {cv::Size(640, 360), usual, cv::Size(1920, 1080)}) {
        const ColourImage screen = draw(size);
        const DeskRect inside = drawn_.picture.shrunk(1);
        EXPECT_EQ(of_colour(screen, inside, {40, 90, 140}), pixels(inside).area()) << size;
        EXPECT_FALSE(drawn_.has_overlay);
    }
}

TEST_F(DeskScreen, CoversNoPartOfProgrammeAndPreviewAtAnySize) {
    desk_.show_preview();
    for (const bool panels : {true, false})
        for (const cv::Size size : {cv::Size(320, 240), cv::Size(640, 360), usual}) {
            switches_.panels = panels;
            const ColourImage screen = draw(size);
            const DeskRect programme = drawn_.picture.shrunk(1);
            EXPECT_EQ(of_colour(screen, programme, {40, 90, 140}), pixels(programme).area())
                << size;
            ASSERT_TRUE(drawn_.preview);
            const DeskRect preview = drawn_.preview->shrunk(1);
            EXPECT_EQ(of_colour(screen, preview, {90, 130, 60}), pixels(preview).area()) << size;
            EXPECT_EQ(&drawn_.in_hand(), &*drawn_.preview);
        }
    state().preview.reset();
    draw();
    EXPECT_EQ(&drawn_.in_hand(), &drawn_.picture);
}

TEST_F(DeskScreen, ShowsCoverageAndFlightOfThePreview) {
    desk_.show_preview();
    const ColourImage before = draw();
    const DeskRect over{layout().preview.left, layout().preview.top, layout().preview.width, 18};
    state().preview->coverage = Coverage{.share = 0.2};
    EXPECT_GT(differing(before, draw(), over), 20);
    const DeskRect name{layout().programme.left, layout().programme.top, layout().programme.width,
                        18};
    state().preview->fly_progress = 0.3;
    EXPECT_GT(differing(before, draw(), name), 20);
}

TEST_F(DeskScreen, ShowsThePictureAloneWithoutPanels) {
    switches_.panels = false;
    const ColourImage screen = draw();
    for (const cv::Point p : {cv::Point(1, 1), cv::Point(640, 360), cv::Point(1278, 718)})
        EXPECT_EQ(at(screen, static_cast<float>(p.x), static_cast<float>(p.y)),
                  cv::Vec3b(40, 90, 140))
            << p;
}

TEST_F(DeskScreen, LetterboxesAPictureOfAnotherShape) {
    Texture filled(TextureFormat::rgba8, 100, 100);
    filled.upload(ColourImage(100, 100, cv::Vec4b(200, 0, 0, 255)));
    state().picture = &filled;
    switches_.panels = false;
    const ColourImage screen = draw();
    EXPECT_EQ(at(screen, 100, 360), cv::Vec3b(0, 0, 0));
    EXPECT_EQ(at(screen, 640, 360), cv::Vec3b(200, 0, 0));
    EXPECT_EQ(at(screen, 290, 5), cv::Vec3b(200, 0, 0)) << "from (1280 - 720) / 2 = 280 on";
    EXPECT_EQ(at(screen, 270, 5), cv::Vec3b(0, 0, 0));
}

TEST_F(DeskScreen, DrawPictureMatchesTheWholeDesk) {
    state().shots.clear();
    ColourImage ramp(180, 320);
    for (int y = 0; y < ramp.rows; ++y)
        for (int x = 0; x < ramp.cols; ++x)
            ramp(y, x) = cv::Vec4b(static_cast<uchar>(x), static_cast<uchar>(y), 77, 0);
    desk_.picture.upload(ramp);
    const ColourImage expected = draw();
    desk_.picture.upload(ColourImage(180, 320, cv::Vec4b(1, 2, 3, 255)));
    const ColourImage before = draw();
    Texture screen(TextureFormat::rgba8, usual.width, usual.height);
    screen.upload(before);
    desk_.picture.upload(ramp);
    renderer_.draw_picture(desk_.picture, drawn_.picture, Framebuffer({&screen}));
    EXPECT_LE(cv::norm(ColourImage(screen.download()), expected, cv::NORM_INF), 1);
}

TEST_F(DeskScreen, ShowsWhetherTheProgrammeIsReadyForAir) {
    const DeskRect status = layout().status;
    state().rigs.resize(1);
    const ColourImage ready = draw();
    state().signal = SignalState::stale;
    const ColourImage stale = draw();
    EXPECT_GT(differing(ready, stale, status), 400);
    state().signal = SignalState::live;
    state().programme_tally = true;
    EXPECT_GT(differing(ready, draw(), status), 400);
}

TEST_F(DeskScreen, ShowsTheStateOfARigInWordsAndPicture) {
    const DeskRect rigs = layout().rigs;
    const DeskRect first{rigs.left, rigs.top, rigs.width / 3, rigs.height};
    const DeskRect rest{rigs.left + rigs.width / 3, rigs.top, 2 * rigs.width / 3, rigs.height};
    const ColourImage before = draw();
    EXPECT_GT(of_colour(before, first, {150, 60, 60}), 5000) << "colour";
    EXPECT_GT(of_colour(before, first, {230, 210, 60}), 2000) << "depth";
    state().rigs[0].state = RigState::refused;
    const ColourImage after = draw();
    EXPECT_EQ(of_colour(after, first, {150, 60, 60}), 0) << "it is veiled";
    EXPECT_GT(differing(before, after, first), 5000);
    EXPECT_EQ(differing(before, after, rest), 0);
}

TEST_F(DeskScreen, ShowsTheWorriesOfARig) {
    const ColourImage before = draw();
    state().rigs[0].worries = {"83 C, it throttles from 80 C on"};
    EXPECT_GT(differing(before, draw(), layout().side), 100);
    EXPECT_GT(differing(before, draw(), layout().rigs), 50);
}

TEST_F(DeskScreen, ShowsTheMarksAndThePlaceOnTheTimeLine) {
    const DeskRect line = layout().time_line;
    const ColourImage live = draw();
    ASSERT_TRUE(drawn_.spots.time.has_value());
    EXPECT_FALSE(drawn_.spots.live.is_empty());
    state().time->at = 1300;
    state().time->in = 1225;
    state().time->out = 1675;
    const ColourImage past = draw();
    const DeskRect bar = drawn_.spots.time->rect;
    const cv::Vec3b between(41, 97, 128);
    const auto marked = [&](double share) {
        const DeskRect there{bar.left + static_cast<float>(share) * bar.width - 3, bar.top, 12,
                             0.5f * bar.height};
        return of_colour(past, there, between) > 10;
    };
    EXPECT_TRUE(marked(0.5));
    EXPECT_FALSE(marked(0.1));
    EXPECT_FALSE(marked(0.9));
    EXPECT_GT(differing(live, past, line), 1000);
}

TEST_F(DeskScreen, ShowsTheKeyframesOfAFlightOnTheTimeLine) {
    const DeskRect line = layout().time_line;
    const ColourImage before = draw();
    state().time->keyframes = {1200, 1500, 5000};
    const ColourImage after = draw();
    const int two = differing(before, after, line);
    EXPECT_GT(two, 20);
    state().time->keyframes.pop_back();
    EXPECT_EQ(differing(after, draw(), line), 0) << "one beyond the past is not shown";
    state().time->keyframes = {1200};
    EXPECT_LT(differing(before, draw(), line), two);
}

TEST_F(DeskScreen, ShowsTheProgressOfThePlannedMove) {
    const DeskRect line = layout().time_line;
    const ColourImage before = draw();
    state().move_progress = 0.8;
    const ColourImage later = draw();
    EXPECT_GT(differing(before, later, line), 300);
    state().move->keyframes = {0, 0.5, 1};
    EXPECT_GT(differing(later, draw(), line), 20);
    state().move.reset();
    state().move_progress.reset();
    EXPECT_GT(differing(before, draw(), line), 1000);
}

TEST_F(DeskScreen, HasNoTimeLineToClickWithoutAPast) {
    state().time.reset();
    draw();
    EXPECT_FALSE(drawn_.spots.time.has_value());
    EXPECT_TRUE(drawn_.spots.live.is_empty());
}

TEST_F(DeskScreen, StoredShotsCanBeClicked) {
    draw();
    ASSERT_EQ(drawn_.spots.shots.size(), 2u);
    EXPECT_EQ(drawn_.spots.shots[0].number, 1);
    EXPECT_EQ(drawn_.spots.shots[1].number, 4);
}

TEST_F(DeskScreen, ClipsAndEntriesCanBeClickedAndShowTheirState) {
    const ColourImage before = draw();
    ASSERT_EQ(drawn_.spots.clips.size(), 4u);
    EXPECT_EQ(drawn_.spots.clips[3].number, 4);
    ASSERT_EQ(drawn_.spots.entries.size(), 3u);
    EXPECT_EQ(drawn_.spots.entries[2].number, 3);
    const DeskLayout parts = layout();
    state().replay.clips[1].is_played = false;
    EXPECT_GT(differing(before, draw(), parts.clips), 100);
    EXPECT_GT(differing(before, draw(), parts.time_line), 20) << "what plays is told there too";
    state().replay.clips[1].is_played = true;
    state().replay.clips[2].loss = "GONE";
    EXPECT_GT(differing(before, draw(), parts.clips), 1000);
    state().replay.clips[2].loss = "";
    state().replay.entries[1].is_playing = false;
    EXPECT_GT(differing(before, draw(), parts.side), 50);
    EXPECT_GT(differing(before, draw(), parts.status), 50) << "it was played of the list";
}

TEST_F(DeskScreen, ShowsTheClipsAroundTheOneInHand) {
    const DeskClip last = state().replay.clips[3];
    for (int number = 5; number <= 20; ++number) {
        DeskClip clip = last;
        clip.number = number;
        state().replay.clips.push_back(clip);
    }
    state().replay.clips[2].is_in_hand = false;
    state().replay.clips[14].is_in_hand = true;
    draw();
    ASSERT_EQ(drawn_.spots.clips.size(), static_cast<std::size_t>(shot_places));
    EXPECT_EQ(drawn_.spots.clips[0].number, 11);
    state().replay.clips[14].is_in_hand = false;
    state().replay.clips[19].is_in_hand = true;
    draw();
    EXPECT_EQ(drawn_.spots.clips.back().number, 20);
}

TEST_F(DeskScreen, ShowsTheCommandLineAndNotices) {
    const DeskRect status = layout().status;
    const ColourImage before = draw();
    state().notice = "clip 3 is not in the replay buffer";
    const ColourImage noticed = draw();
    EXPECT_GT(differing(before, noticed, status), 1000);
    state().typed = "> clip_speed 50_";
    EXPECT_GT(differing(noticed, draw(), status), 1000);
}

TEST_F(DeskScreen, OutputsCanBeClicked) {
    draw();
    ASSERT_EQ(drawn_.spots.outputs.size(), 3u);
    EXPECT_EQ(drawn_.spots.outputs[2].number, 3);
}

TEST_F(DeskScreen, ThePlanFollowsTheCamera) {
    const ColourImage before = draw();
    state().view.azimuth_rad = 0.6;
    const DeskRect side = layout().side;
    EXPECT_GT(differing(before, draw(), {side.left, side.top, side.width, 0.4f * side.height}),
              300);
}

TEST_F(DeskScreen, The3dViewShowsTheStageAndTurns) {
    desk_.add_points();
    const ColourImage plan = draw();
    EXPECT_TRUE(drawn_.spots.outside.is_empty());
    switches_.outside = true;
    const ColourImage outside = draw();
    const DeskRect part = drawn_.spots.outside;
    ASSERT_FALSE(part.is_empty());
    EXPECT_GT(differing(plan, outside, part), 3000);
    EXPECT_GT(of_colour(outside, part, {220, 150, 60}), 100) << "the performer";
    switches_.eye.turn(1.5, 0);
    EXPECT_GT(differing(outside, draw(), part), 1000);
    state().view.azimuth_rad += 0.5;
    const ColourImage turned = draw();
    state().plan->points.clear();
    EXPECT_EQ(of_colour(draw(), part, {220, 150, 60}), 0);
    EXPECT_GT(differing(turned, draw(), part), 300);
    state().plan.reset();
    draw();
}

TEST_F(DeskScreen, WithoutTheRigsTheRestIsLarger) {
    draw();
    const float before = drawn_.spots.time->rect.bottom();
    switches_.rigs = false;
    draw();
    EXPECT_GT(drawn_.spots.time->rect.bottom(), before + 100);
}

TEST_F(DeskScreen, NamesTheColoursOfTheSourceMap) {
    const DeskRect side = layout().side;
    const cv::Vec3b of_north(230, 20, 200), of_filled(255, 0, 255);
    EXPECT_EQ(of_colour(draw(), side, of_north) + of_colour(draw(), side, of_filled), 0);
    state().sources = {{{"north", {230, 20, 200}, 0.61}, {"inpainted", {255, 0, 255}, 0.04}}, ""};
    EXPECT_GT(of_colour(draw(), side, of_north), 40);
    EXPECT_GT(of_colour(draw(), side, of_filled), 40);
    const ColourImage shares = draw();
    state().sources = {{}, "The synthesiser points has no source map."};
    EXPECT_GT(differing(shares, draw(), side), 100);
}

TEST_F(DeskScreen, OpensTheHelpOverEverythingElse) {
    const ColourImage before = draw();
    EXPECT_EQ(drawn_.help_pages, 0);
    switches_.help = 1;
    const ColourImage after = draw();
    EXPECT_TRUE(drawn_.has_overlay);
    EXPECT_EQ(drawn_.help_pages, 1);
    EXPECT_GT(differing(before, after, {440, 200, 400, 300}), 60000);
}

TEST_F(DeskScreen, TheHelpHasPagesInASmallWindow) {
    const cv::Size small(640, 360);
    switches_.help = 1;
    const ColourImage first = draw(small);
    const int pages = drawn_.help_pages;
    EXPECT_GT(pages, 1);
    for (switches_.help = 2; switches_.help <= pages; ++switches_.help)
        EXPECT_GT(differing(first, draw(small), {0, 0, 640, 360}), 5000) << switches_.help;
}

TEST_F(DeskScreen, ShowsAQuestion) {
    const ColourImage before = draw();
    state().question = "Press Esc again to quit";
    EXPECT_GT(differing(before, draw(), layout().status), 1000);
}

TEST_F(DeskScreen, DrawsAnEmptyStateAtAnySize) {
    state() = DeskState();
    for (const cv::Size size : {cv::Size(320, 240), cv::Size(640, 360), usual}) {
        const ColourImage screen = draw(size);
        double most = 0;
        cv::minMaxLoc(ColourImage(screen.rowRange(0, 22)).reshape(1), nullptr, &most);
        EXPECT_GT(most, 150) << "it says why: " << size;
    }
}

TEST_F(DeskScreen, ControlsOfAWheelMapCanBeClicked) {
    desk_.open_wheel_map();
    draw();
    EXPECT_TRUE(drawn_.has_overlay);
    std::set<int> numbers;
    for (const DeskSpots::Numbered& spot : drawn_.spots.wheel_controls) numbers.insert(spot.number);
    EXPECT_EQ(numbers.size(), state().wheel_map->controls.size());
}

TEST_F(DeskScreen, ListsTheCommandsOfAControl) {
    desk_.open_wheel_map();
    DeskWheel& wheel = *state().wheel_map;
    const ColourImage feel = draw();
    wheel.is_choosing = true;
    wheel.typed = "mar";
    for (int i = 0; i < 40; ++i) wheel.choices.push_back({fmt::format("mark_{}", i), "mark it"});
    wheel.chosen = 30;
    const DeskRect all{0, 0, 1280, 720};
    const ColourImage choosing = draw();
    EXPECT_GT(differing(feel, choosing, all), 1000);
    wheel.chosen = 31;
    EXPECT_GT(differing(choosing, draw(), all), 100) << "the list goes along";
}

TEST_F(DeskScreen, ShowsASmallMessageWithoutAWheel) {
    state().wheel_map.reset();
    const ColourImage closed = draw();
    state().wheel_map = DeskWheel();
    const ColourImage open = draw();
    EXPECT_GT(differing(closed, open, drawn_.picture), 1000);
    EXPECT_TRUE(drawn_.spots.wheel_controls.empty());
    const DeskRect above{0, 0, 1280, 288};
    EXPECT_LT(differing(closed, open, above), 100);
}

}  // namespace
}  // namespace vantage
