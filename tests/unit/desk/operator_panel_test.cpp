#include "host_app/desk/operator_panel.h"

#include <cstdlib>

#include <gtest/gtest.h>

#include "common/gl/egl_context.h"
#include "common/image/colour_map.h"
#include "common/image/image_file.h"
#include "host_app/desk/ui_renderer.h"

namespace vantage {
namespace {

const cv::Size large_screen{1280, 720}, smallest_screen{960, 540};

class OperatorScreen : public testing::Test {
  protected:
    OperatorScreen()
        : picture_(TextureFormat::rgba8, 320, 180), disparity_(TextureFormat::rgba8, 160, 120) {
        // Alpha 0, as where no rig saw the surface: the screen shows the pixel all the same.
        picture_.upload(ColourImage(180, 320, cv::Vec4b(40, 90, 140, 0)));
        cv::Mat1f ramp(120, 160);
        for (int y = 0; y < ramp.rows; ++y)
            for (int x = 0; x < ramp.cols; ++x) ramp(y, x) = static_cast<float>(x) * 0.2f;
        disparity_.upload(colour_map_disparity(ramp, 0, 32));

        state_.picture = &picture_;
        state_.waiting = false;
        state_.recording = true;
        state_.timecode = "10:00:07:12";
        state_.pulse = 1234567;
        state_.picture_rate_hz = 29.97;
        state_.latency_ms = 84;
        for (int i = 0; i < 100; ++i)
            state_.latency_history_ms.push_back(80.0f + static_cast<float>(i % 13));
        state_.synthesiser = "mesh";
        state_.stages = {{"capture", 2.1, true}, {"match", 18.4, true}, {"decode", 3.2, false}};
        state_.rigs = {{"north", RigState::present, 30, 60, 0, &disparity_},
                       {"south", RigState::late, 28.1, 190, 17, &disparity_},
                       {"east", RigState::disconnected, 0, 0, 0, nullptr}};
        state_.outputs = {{"film flight.mkv", "on", true, false, 6.2, 1, 3, ""},
                          {"srt://0.0.0.0:9000?mode=listener&passphrase=***",
                           "waiting for a caller", false, false, 0, 0, 0, ""},
                          {"v4l2:/dev/video10", "FAILED", false, true, 0, 0, 0,
                           "/dev/video10 cannot be opened: No such file or directory"}};
        state_.move_progress = 0.4;
    }

    ColourImage draw(const PanelState& state, cv::Size size = large_screen) {
        ImGui::GetIO().DisplaySize = {static_cast<float>(size.width),
                                      static_cast<float>(size.height)};
        const Texture screen(TextureFormat::rgba8, size.width, size.height);
        const Framebuffer target({&screen});
        // A panel takes its size from what it held in the frame before.
        for (int frame = 0; frame < 2; ++frame) {
            ImGui::NewFrame();
            draw_operator_screen(state, ui_.fonts());
            ImGui::Render();
            renderer_.draw(*ImGui::GetDrawData(), target);
        }
        const ColourImage drawn = screen.download();
        // For looking at it.
        if (const char* file = std::getenv("VANTAGE_TEST_PICTURE")) write_colour_image(file, drawn);
        return drawn;
    }
    static cv::Vec3b at(const ColourImage& screen, int x, int y) {
        const cv::Vec4b& pixel = screen(y, x);
        return {pixel[0], pixel[1], pixel[2]};
    }
    static int differing(const ColourImage& a, const ColourImage& b, cv::Rect region) {
        ColourImage difference;
        cv::absdiff(a(region), b(region), difference);
        int count = 0;
        for (const cv::Vec4b& d : difference) count += d[0] + d[1] + d[2] > 60;
        return count;
    }

    EglContext context_;
    ShaderLibrary shaders_;
    UiContext ui_{13};
    UiRenderer renderer_{shaders_};
    Texture picture_, disparity_;
    PanelState state_;
};

TEST_F(OperatorScreen, ShowsTheTakeAndWhereInThePastItIs) {
    const ColourImage before = draw(state_);
    PanelState taking = state_;
    taking.take = {.is_running = true,
                   .path = "",
                   .duration_s = 75,
                   .mb_s = 36.9,
                   .left_out = 3,
                   .failure = ""};
    taking.time = {.speed = 0.5, .at = 0.3, .in = 0.25, .out = 0.75, .loops = true};
    const ColourImage after = draw(taking);
    // The line of time lies right under the bar: green between the marks only.
    const auto colour_at = [&](const ColourImage& screen, double share) {
        const int x = cvRound(share * screen.cols);
        for (int y = 35; y < 38; ++y)
            if (screen(y, x)[1] > 150 && screen(y, x)[0] < 120) return true;
        return false;
    };
    EXPECT_TRUE(colour_at(after, 0.5));
    EXPECT_FALSE(colour_at(before, 0.5));
    EXPECT_FALSE(colour_at(after, 0.2));
    EXPECT_GT(cv::norm(before, after, cv::NORM_L1), 10000);
}

TEST_F(OperatorScreen, ShowsThePictureInItsShapeAndColour) {
    state_.show_panels = false;
    const ColourImage screen = draw(state_);
    for (const cv::Point p : {cv::Point(1, 1), cv::Point(640, 360), cv::Point(1278, 718)})
        EXPECT_EQ(at(screen, p.x, p.y), cv::Vec3b(40, 90, 140)) << p;
}

TEST_F(OperatorScreen, LetterboxesAPictureOfAnotherShape) {
    Texture filled(TextureFormat::rgba8, 100, 100);
    filled.upload(ColourImage(100, 100, cv::Vec4b(200, 0, 0, 255)));
    state_.picture = &filled;
    state_.show_panels = false;
    const ColourImage screen = draw(state_);
    EXPECT_LT(at(screen, 100, 360)[0], 20);
    EXPECT_EQ(at(screen, 640, 360), cv::Vec3b(200, 0, 0));
    EXPECT_EQ(at(screen, 290, 5), cv::Vec3b(200, 0, 0)) << "from (1280 - 720) / 2 = 280 on";
    EXPECT_LT(at(screen, 270, 5)[0], 20);
}

TEST_F(OperatorScreen, LeavesTheMiddleOfThePictureFree) {
    const ColourImage screen = draw(state_);
    for (const cv::Point p : {cv::Point(640, 360), cv::Point(500, 200), cv::Point(900, 450)})
        EXPECT_EQ(at(screen, p.x, p.y), cv::Vec3b(40, 90, 140)) << p;
}

TEST_F(OperatorScreen, TellsTheStateOfARig) {
    const ColourImage before = draw(state_);
    state_.rigs[0].state = RigState::refused;
    const ColourImage after = draw(state_);
    EXPECT_GT(differing(before, after, {0, 40, 400, 300}), 20) << "the table";
    EXPECT_GT(differing(before, after, {400, 500, 500, 220}), 500) << "its disparity goes";
}

TEST_F(OperatorScreen, NamesTheColoursOfTheNoveltyOverlay) {
    const cv::Rect panel(960, 30, 320, 300);
    const auto patch = [&](cv::Scalar colour) {
        cv::Mat1b mask;
        cv::inRange(ColourImage(draw(state_)(panel)), colour, colour, mask);
        return cv::countNonZero(mask);
    };
    const cv::Scalar of_north(230, 159, 0, 255), of_filled(255, 0, 255, 255);
    EXPECT_EQ(patch(of_north) + patch(of_filled), 0);
    state_.novelty = {{{"north", {230, 159, 0}, 0.61}, {"filled", {255, 0, 255}, 0.04}}, ""};
    EXPECT_GT(patch(of_north), 40);
    EXPECT_GT(patch(of_filled), 40);
    const ColourImage shares = draw(state_);
    state_.novelty = {{}, "The synthesiser points cannot tell."};
    EXPECT_GT(differing(shares, draw(state_), panel), 100);
}

TEST_F(OperatorScreen, ShowsWhatATechnicianShouldLookAfter) {
    const ColourImage before = draw(state_);
    state_.rigs[0].worries = {"83 C, it slows down from 80", "its supply sags"};
    EXPECT_GT(differing(before, draw(state_), {0, 40, 400, 400}), 100);
}

TEST_F(OperatorScreen, ShowsTheDisparitiesInColour) {
    const ColourImage screen = draw(state_);
    cv::Mat1b red, blue;
    cv::inRange(screen, cv::Scalar(180, 0, 0, 0), cv::Scalar(255, 80, 60, 255), red);
    cv::inRange(screen, cv::Scalar(20, 20, 120, 0), cv::Scalar(90, 130, 255, 255), blue);
    const cv::Rect strip(300, 520, 680, 200);
    EXPECT_GT(cv::countNonZero(red(strip)), 50);
    EXPECT_GT(cv::countNonZero(blue(strip)), 50);
}

TEST_F(OperatorScreen, KeepsDisparitiesOffTheTableOfRigsOnTheSmallestScreen) {
    state_.rigs.assign(4, {"north", RigState::present, 30, 60, 0, &disparity_});
    state_.stages.assign(10, {"capture", 2.1, true});
    const ColourImage before = draw(state_, smallest_screen);
    Texture other(TextureFormat::rgba8, 160, 120);
    other.upload(ColourImage(120, 160, cv::Vec4b(255, 0, 255, 255)));
    for (PanelRig& rig : state_.rigs) rig.disparity = &other;
    const ColourImage after = draw(state_, smallest_screen);
    EXPECT_EQ(differing(before, after, {0, 0, 305, 540}), 0);
    EXPECT_EQ(at(after, 340, 460), cv::Vec3b(255, 0, 255)) << "the first one is whole";
    EXPECT_EQ(at(after, 900, 460), cv::Vec3b(255, 0, 255)) << "and so is the last one";
}

TEST_F(OperatorScreen, OpensTheHelpOverThePicture) {
    const ColourImage before = draw(state_);
    state_.show_help = true;
    const ColourImage after = draw(state_);
    EXPECT_GT(differing(before, after, {440, 200, 400, 300}), 60000);
}

TEST_F(OperatorScreen, DrawsWithNothingToShow) {
    const ColourImage screen = draw(PanelState());
    EXPECT_LT(at(screen, 640, 360)[0], 20);
    ColourImage bar = screen(cv::Rect(0, 0, screen.cols, 30));
    double most = 0;
    cv::minMaxLoc(bar.reshape(1), nullptr, &most);
    EXPECT_GT(most, 200) << "the title";
}

TEST_F(OperatorScreen, WarnsBesideTheSignalWhereTheRigsCoverTooLittle) {
    const cv::Rect bar(0, 0, large_screen.width, 33);
    state_.coverage = Coverage{.share = 0.99};
    const ColourImage inside = draw(state_);
    state_.coverage = Coverage{.share = 0.75, .loss = CoverageLoss::aside};
    const ColourImage edge = draw(state_);
    state_.coverage = Coverage{.share = 0.3, .loss = CoverageLoss::aside};
    const ColourImage beyond = draw(state_);
    EXPECT_GT(differing(inside, edge, bar), 500);
    EXPECT_GT(differing(edge, beyond, bar), 500);
    const cv::Rect camera_panel(large_screen.width - 250, 40, 250, 250);
    EXPECT_GT(differing(inside, beyond, camera_panel), 100) << "with the reason";
}

}  // namespace
}  // namespace vantage
