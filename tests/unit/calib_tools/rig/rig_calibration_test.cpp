#include "calib_tools/rig/rig_calibration.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calib_tools/report/calibration_json.h"
#include "calib_tools/report/calibration_text.h"
#include "common/base/error.h"
#include "common/image/picture_list.h"
#include "tests/support/data_folder.h"
#include "tests/unit/calib_tools/rig/synthetic_views.h"

namespace vantage {
namespace {

using testing::HasSubstr;

const BoardPattern chessboard = chessboard_pattern("9x6", 0.04);

std::string failure_of(const SyntheticRig::Series& series, const BoardPattern& board = chessboard) {
    try {
        calibrate_rig(series.left, series.right, board, {.family = &lens_family("brown4")});
        return "no failure";
    } catch (const Error& error) {
        return error.what();
    }
}

TEST(RigCalibration, recovers_a_known_rig_and_states_uncertainties_that_cover_it) {
    const SyntheticRig rig;
    SyntheticViews views(chessboard, 0.1);
    const SyntheticRig::Series series = rig.film(views, 20);
    ASSERT_EQ(series.left.size(), 20u);
    const RigCalibration c =
        calibrate_rig(series.left, series.right, chessboard, {.family = &lens_family("brown4")});
    EXPECT_EQ(c.views_used, 20u);
    EXPECT_TRUE(c.rejected.empty());
    EXPECT_NEAR(c.uncertainty.residual_sigma_px, 0.1, 0.01);
    const BundleUncertainty::Camera& sigma = c.uncertainty.cameras[0];
    EXPECT_GT(sigma.fx_px, 0.01);
    EXPECT_LT(sigma.fx_px, 1.0);
    EXPECT_NEAR(c.calibration.left.fx_px, rig.left.fx_px, 4 * sigma.fx_px);
    EXPECT_NEAR(c.calibration.left.cy_px, rig.left.cy_px, 4 * sigma.cy_px);
    EXPECT_NEAR(c.baseline_m, rig.right_from_left.translation().norm(), 4 * c.baseline_sigma_m);
    EXPECT_LT(c.baseline_sigma_m, 0.001);
    EXPECT_LT(c.row_rms_px, 0.16);
}

TEST(RigCalibration, errs_by_as_much_as_it_says_over_many_films) {
    const SyntheticRig rig;
    constexpr int films = 6;
    double squares = 0;
    int count = 0;
    const auto add = [&](double solved, double truth, double sigma) {
        squares += std::pow((solved - truth) / sigma, 2);
        ++count;
    };
    for (std::uint64_t seed = 1; seed <= films; ++seed) {
        SyntheticViews views(chessboard, 0.1, 100 + seed);
        const SyntheticRig::Series series = rig.film(views, 10);
        const RigCalibration c = calibrate_rig(series.left, series.right, chessboard,
                                               {.family = &lens_family("brown4")});
        for (const bool is_left : {true, false}) {
            const CameraModel& truth = is_left ? rig.left : rig.right;
            const CameraModel& solved = is_left ? c.calibration.left : c.calibration.right;
            const BundleUncertainty::Camera& sigma = c.uncertainty.cameras[is_left ? 0 : 1];
            add(solved.fx_px, truth.fx_px, sigma.fx_px);
            add(solved.fy_px, truth.fy_px, sigma.fy_px);
            add(solved.cx_px, truth.cx_px, sigma.cx_px);
            add(solved.cy_px, truth.cy_px, sigma.cy_px);
            for (std::size_t k = 0; k < 4; ++k)
                add(solved.distortion[k], truth.distortion[k], sigma.distortion[k]);
        }
        add(c.baseline_m, rig.right_from_left.translation().norm(), c.baseline_sigma_m);
    }
    const double normalized_rms = std::sqrt(squares / count);
    RecordProperty("normalized_rms", std::to_string(normalized_rms));
    EXPECT_GT(normalized_rms, 0.7);
    EXPECT_LT(normalized_rms, 1.3);
}

TEST(RigCalibration, recovers_small_pictures_whose_pixels_are_not_square) {
    SyntheticRig rig;
    for (CameraModel* camera : {&rig.left, &rig.right}) {
        camera->width_px = 320;
        camera->height_px = 240;
        camera->fx_px *= 0.5;
        camera->fy_px *= 0.5 * 1.25;
        camera->cx_px *= 0.5;
        camera->cy_px *= 0.5;
    }
    SyntheticViews views(chessboard, 0.15);
    const SyntheticRig::Series series = rig.film(views, 12);
    ASSERT_EQ(series.left.size(), 12u);
    const RigCalibration c = calibrate_rig(series.left, series.right, chessboard, {});
    for (const bool is_left : {true, false}) {
        const CameraModel& truth = is_left ? rig.left : rig.right;
        const CameraModel& solved = is_left ? c.calibration.left : c.calibration.right;
        EXPECT_NEAR(solved.fx_px, truth.fx_px, 0.01 * truth.fx_px);
        EXPECT_NEAR(solved.fy_px, truth.fy_px, 0.01 * truth.fy_px);
    }
    EXPECT_NEAR(c.baseline_m, rig.right_from_left.translation().norm(), 5 * c.baseline_sigma_m);
    EXPECT_THAT(c.doubts, testing::Contains(HasSubstr("times as wide as high")));
}

/// The picture turned by 180 degrees, numbered as the finder numbers a board that looks alike then.
void turn_half_round(SeenPicture& picture, const BoardPattern& pattern) {
    BoardCorners turned;
    for (auto corner = picture.sighting.corners.rbegin(); corner != picture.sighting.corners.rend();
         ++corner) {
        const int id = pattern.corner_count() - 1 - corner->id;
        turned.push_back(
            {id, pattern.corner_m(id),
             Eigen::Vector2d(picture.width_px - 1, picture.height_px - 1) - corner->pixel});
    }
    picture.sighting.corners = turned;
}

TEST(RigCalibration, names_every_picture_that_is_turned_half_round) {
    const BoardPattern alike = chessboard_pattern("8x6", 0.04);
    SyntheticViews views(alike, 0.05);
    SyntheticRig::Series series = SyntheticRig().film(views, 14);
    for (const std::size_t i : {1, 3, 5, 7}) turn_half_round(series.right[i], alike);
    turn_half_round(series.left[10], alike);
    const RigCalibration c =
        calibrate_rig(series.left, series.right, alike, {.family = &lens_family("radial2")});
    EXPECT_EQ(c.views_used, 9u);
    std::vector<std::string> named;
    for (const Refusal& refusal : c.rejected) {
        named.push_back(refusal.name);
        EXPECT_THAT(refusal.reason, HasSubstr("half round"));
    }
    EXPECT_THAT(named, testing::UnorderedElementsAre("right1.png", "right3.png", "right5.png",
                                                     "right7.png", "left10.png"));
    EXPECT_NEAR(c.baseline_m, 0.12, 0.005);
}

TEST(RigCalibration, says_that_cameras_are_toed_in) {
    SyntheticRig rig;
    rig.right_from_left.linear() =
        Eigen::AngleAxisd(0.35, Eigen::Vector3d::UnitY()).toRotationMatrix();
    SyntheticViews views(chessboard, 0.05);
    const SyntheticRig::Series series = rig.film(views, 12);
    ASSERT_EQ(series.left.size(), 12u);
    const RigCalibration c =
        calibrate_rig(series.left, series.right, chessboard, {.family = &lens_family("radial2")});
    EXPECT_THAT(c.doubts, testing::Contains(HasSubstr("look 20 degrees apart")));
    EXPECT_THAT(c.doubts, testing::Contains(HasSubstr("the disparity is 0 at")));
    EXPECT_NEAR(std::abs(c.aim.toe_in_deg), 20, 0.5);
    const RectifiedStereo& own = c.calibration.rectified;
    EXPECT_NEAR(farthest_m(own), 2 * c.aim.crossing_m, 1e-6);
    const std::string text = describe(c);
    EXPECT_THAT(text, HasSubstr("aim: toed in by"));
    EXPECT_THAT(text, HasSubstr("with 64 disparities"));
    // The user's distance wins, and infinity gives both sides one principal point.
    const RigCalibration far = calibrate_rig(
        series.left, series.right, chessboard,
        {.family = &lens_family("radial2"), .far_m = std::numeric_limits<double>::infinity()});
    EXPECT_EQ(far.calibration.rectified.doffs_px(), 0);
    EXPECT_GT(far.calibration.rectified.f_px, own.f_px) << "more is cut off";
}

TEST(RigCalibration, names_the_roll_of_the_right_camera) {
    SyntheticRig rig;
    rig.right_from_left.linear() =
        Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    SyntheticViews views(chessboard, 0.05);
    const SyntheticRig::Series series = rig.film(views, 12);
    const RigCalibration c =
        calibrate_rig(series.left, series.right, chessboard, {.family = &lens_family("radial2")});
    EXPECT_THAT(c.doubts, testing::Contains(HasSubstr("rolled by 5.7 degrees")));
}

TEST(RigCalibration, takes_up_a_row_that_one_side_is_off) {
    SyntheticViews views(chessboard, 0.05);
    SyntheticRig::Series series = SyntheticRig().film(views, 12);
    const auto calibrate = [&] {
        return calibrate_rig(series.left, series.right, chessboard,
                             {.family = &lens_family("radial2")});
    };
    const RigCalibration before = calibrate();
    for (SeenPicture& picture : series.right)
        for (BoardCorner& corner : picture.sighting.corners) corner.pixel.y() += 1;
    const RigCalibration off = calibrate();
    EXPECT_NEAR(off.calibration.right.cy_px - before.calibration.right.cy_px, 1, 0.01);
    EXPECT_NEAR(off.row_rms_px, before.row_rms_px, 0.01);
}

TEST(RigCalibration, uses_or_names_every_pair) {
    SyntheticViews views(chessboard, 0.05);
    SyntheticRig::Series series = SyntheticRig().film(views, 12);
    // One of another instant, and one of which nearly all corners were measured wrong.
    std::swap(series.right[2].sighting.corners, series.right[3].sighting.corners);
    for (std::size_t i = 3; i < series.right[5].sighting.corners.size(); ++i)
        series.right[5].sighting.corners[i].pixel += Eigen::Vector2d(2.0 + 0.1 * (i % 7), -1.5);
    const RigCalibration c =
        calibrate_rig(series.left, series.right, chessboard, {.family = &lens_family("radial2")});
    EXPECT_EQ(c.views_used + c.rejected.size(), 12u);
    EXPECT_THAT(c.rejected, testing::Contains(
                                testing::Field(&Refusal::reason, HasSubstr("not of one instant"))));
}

TEST(RigCalibration, of_the_same_pictures_is_the_same_to_the_last_bit) {
    const auto id_of_a_run = [] {
        SyntheticViews views(chessboard, 0.1);
        const SyntheticRig::Series series = SyntheticRig().film(views, 8);
        return calibration_checksum(calibrate_rig(series.left, series.right, chessboard,
                                                  {.family = &lens_family("radial2")})
                                        .calibration);
    };
    const std::string first = id_of_a_run();
    std::vector<std::vector<char>> holes;
    for (int i = 0; i < 3; ++i) {
        // Another heap each time, as the threads that look at pictures leave it.
        for (int k = 0; k < 50; ++k) holes.emplace_back(static_cast<std::size_t>(37 * k + 100 * i));
        for (std::size_t k = 0; k < holes.size(); k += 2) holes[k] = {};
        EXPECT_EQ(id_of_a_run(), first);
    }
}

TEST(RigCalibration, of_a_sound_rig_has_no_doubts) {
    SyntheticViews views(chessboard, 0.1);
    const SyntheticRig::Series series = SyntheticRig().film(views, 10);
    const RigCalibration c =
        calibrate_rig(series.left, series.right, chessboard, {.family = &lens_family("brown4")});
    EXPECT_THAT(c.doubts, testing::IsEmpty());
}

TEST(RigCalibration, says_that_it_rests_on_few_views) {
    SyntheticViews views(chessboard, 0.05);
    const SyntheticRig::Series series = SyntheticRig().film(views, 4);
    const RigCalibration c =
        calibrate_rig(series.left, series.right, chessboard, {.family = &lens_family("radial2")});
    EXPECT_THAT(c.doubts, testing::Contains(HasSubstr("rests on 4 views")));
    EXPECT_EQ(to_json(c)["doubts"].size(), c.doubts.size());
}

TEST(RigCalibration, doubts_boards_that_are_bent) {
    SyntheticViews views(chessboard, 0.05);
    SyntheticRig::Series series = SyntheticRig().film(views, 10);
    for (std::vector<SeenPicture>* side : {&series.left, &series.right})
        for (SeenPicture& picture : *side) {
            const double bend_px = 3 * std::sin(picture.name().size() + picture.name()[4]);
            for (BoardCorner& corner : picture.sighting.corners)
                corner.pixel.y() += bend_px * std::cos(0.9 * (corner.id % chessboard.columns));
        }
    const RigCalibration c =
        calibrate_rig(series.left, series.right, chessboard, {.family = &lens_family("radial2")});
    EXPECT_THAT(c.doubts, testing::Contains(HasSubstr("bent")));
}

/// Pairs whose board moves by up to this much between the left and the right exposure.
SyntheticRig::Series loose_pairs(double moves_m) {
    const SyntheticRig rig;
    SyntheticViews views(chessboard, 0.05);
    SyntheticRig::Series series;
    for (int i = 0; i < 12; ++i) {
        Pose pose;
        SeenPicture left, right;
        do {
            pose = views.hold_board(0.8, 0.3);
            left = views.see(rig.left, pose, "left" + std::to_string(i) + ".png");
            pose.translation() += moves_m * Eigen::Vector3d(std::sin(3 * i), std::cos(2 * i), 0);
            right = views.see(rig.right, rig.right_from_left * pose,
                              "right" + std::to_string(i) + ".png");
        } while (!left.sighting.found() || !right.sighting.found());
        series.left.push_back(left);
        series.right.push_back(right);
    }
    return series;
}

TEST(RigCalibration, doubts_pairs_that_are_not_quite_of_one_instant) {
    const SyntheticRig::Series series = loose_pairs(0.002);
    const RigCalibration c =
        calibrate_rig(series.left, series.right, chessboard, {.family = &lens_family("brown4")});
    EXPECT_THAT(c.doubts, testing::Contains(HasSubstr("not of one instant")));
}

TEST(RigCalibration, refuses_pairs_that_are_not_of_one_instant) {
    EXPECT_THAT(failure_of(loose_pairs(0.012)), HasSubstr("not of one instant"));
}

TEST(RigCalibration, names_a_camera_that_is_upside_down) {
    SyntheticViews views(chessboard);
    SyntheticRig::Series series = SyntheticRig().film(views, 8);
    for (SeenPicture& picture : series.right)
        for (BoardCorner& corner : picture.sighting.corners)
            corner.pixel =
                Eigen::Vector2d(picture.width_px - 1, picture.height_px - 1) - corner.pixel;
    EXPECT_THAT(failure_of(series), HasSubstr("turned by"));
}

TEST(RigCalibration, leaves_out_copies_of_a_picture_and_says_of_which) {
    SyntheticViews views(chessboard);
    SyntheticRig::Series series = SyntheticRig().film(views, 9);
    for (const std::size_t copy : {3u, 6u}) {
        series.left[copy].sighting = series.left[0].sighting;
        series.right[copy].sighting = series.right[0].sighting;
    }
    const RigCalibration c =
        calibrate_rig(series.left, series.right, chessboard, {.family = &lens_family("brown4")});
    EXPECT_EQ(c.views_used, 7u);
    ASSERT_EQ(c.rejected.size(), 4u);
    EXPECT_EQ(c.rejected[0].name, "left3.png");
    EXPECT_THAT(c.rejected[0].reason, HasSubstr("the same picture as left0.png"));
}

TEST(Lens, that_folds_the_picture_over_in_its_corners_alone_is_implausible) {
    CameraModel camera = synthetic_camera(340, 340, -0.32);
    camera.distortion = {-0.32, 0.12, 0, 0, -0.018};
    EXPECT_THAT(implausibility(camera), HasSubstr("folds"));
    camera.distortion = {-0.2, 0.05, 0, 0, 0};
    EXPECT_EQ(implausibility(camera), "");
}

TEST(RigCalibration, chooses_a_lens_that_predicts_withheld_views) {
    const SyntheticRig rig;
    SyntheticViews views(chessboard);
    const SyntheticRig::Series series = rig.film(views, 12);
    const RigCalibration c = calibrate_rig(series.left, series.right, chessboard, {});
    EXPECT_GE(c.bundle.cameras[0].family->free_count(), 2);
    EXPECT_LE(c.bundle.cameras[0].family->free_count(), 5);
    EXPECT_NEAR(c.calibration.left.fx_px, rig.left.fx_px, 2);
}

TEST(RigCalibration, names_swapped_sides) {
    SyntheticViews views(chessboard);
    SyntheticRig::Series series = SyntheticRig().film(views, 8);
    std::swap(series.left, series.right);
    EXPECT_THAT(failure_of(series), HasSubstr("swapped"));
}

TEST(RigCalibration, names_pictures_mirrored_against_each_other) {
    SyntheticViews views(chessboard);
    SyntheticRig::Series series = SyntheticRig().film(views, 8);
    for (SeenPicture& picture : series.right) {
        BoardCorners mirrored;
        // As the finder numbers a mirrored 9x6 board: rows from the other side keep squares black.
        for (int row = chessboard.rows - 1; row >= 0; --row)
            for (int column = 0; column < chessboard.columns; ++column) {
                BoardCorner corner =
                    picture.sighting
                        .corners[static_cast<std::size_t>(row * chessboard.columns + column)];
                corner.pixel.x() = picture.width_px - 1 - corner.pixel.x();
                corner.id = static_cast<int>(mirrored.size());
                corner.board_m = chessboard.corner_m(corner.id);
                mirrored.push_back(corner);
            }
        picture.sighting.corners = mirrored;
    }
    EXPECT_THAT(failure_of(series), HasSubstr("mirrored against each other"));
}

TEST(RigCalibration, names_one_camera_given_twice) {
    SyntheticViews views(chessboard);
    SyntheticRig::Series series = SyntheticRig().film(views, 8);
    series.right = series.left;
    EXPECT_THAT(failure_of(series), HasSubstr("one and the same camera"));
}

TEST(RigCalibration, names_pairs_that_are_out_of_step) {
    SyntheticViews views(chessboard);
    SyntheticRig::Series series = SyntheticRig().film(views, 9);
    series.left.pop_back();
    series.right.erase(series.right.begin());
    EXPECT_THAT(failure_of(series), HasSubstr("out of step"));
}

TEST(RigCalibration, names_two_resolutions) {
    SyntheticViews views(chessboard);
    SyntheticRig::Series series = SyntheticRig().film(views, 8);
    for (SeenPicture& picture : series.right) {
        picture.width_px = 320;
        picture.height_px = 240;
        for (BoardCorner& corner : picture.sighting.corners) corner.pixel *= 0.5;
    }
    EXPECT_THAT(failure_of(series), HasSubstr("640x480 and the right ones 320x240"));
}

TEST(RigCalibration, refuses_boards_that_all_face_the_camera) {
    SyntheticRig rig;
    SyntheticViews views(chessboard, 0.2);
    SyntheticRig::Series series;
    for (int i = 0; i < 6; ++i) {
        Pose pose = Pose::Identity();
        pose.translation() = Eigen::Vector3d(-0.16 + 0.01 * i, -0.1, 0.8);
        series.left.push_back(views.see(rig.left, pose, "l"));
        series.right.push_back(views.see(rig.right, rig.right_from_left * pose, "r"));
    }
    EXPECT_THAT(failure_of(series), HasSubstr("tilted"));
}

TEST(RigCalibration, leaves_out_a_view_that_contradicts_the_others_and_says_which) {
    SyntheticViews views(chessboard);
    SyntheticRig::Series series = SyntheticRig().film(views, 12);
    for (BoardCorner& corner : series.right[5].sighting.corners)
        corner.pixel += Eigen::Vector2d(3 * std::sin(corner.id), 9);
    const RigCalibration c =
        calibrate_rig(series.left, series.right, chessboard, {.family = &lens_family("brown4")});
    ASSERT_EQ(c.rejected.size(), 1u);
    EXPECT_THAT(c.rejected[0].name, HasSubstr("right5.png"));
    EXPECT_THAT(c.rejected[0].reason, HasSubstr("contradicts"));
    EXPECT_EQ(c.views_used, 11u);
    EXPECT_EQ(to_json(c)["rejected"].size(), 1u);
}

TEST(RigCalibration, reaches_its_numbers_on_real_chessboards) {
    VANTAGE_REQUIRE_DATA(data);
    const std::string folder = (data / "opencv_chessboard").string();
    const BoardPattern board = chessboard_pattern("9x6", 1.0);
    const PicturePairs pictures = pair_pictures(expand_pictures(folder + "/left*.png"),
                                                expand_pictures(folder + "/right*.png"));
    std::vector<std::filesystem::path> left, right;
    for (const auto& [l, r] : pictures.pairs) {
        left.push_back(l);
        right.push_back(r);
    }
    const RigCalibration c =
        calibrate_rig(look_at_pictures(left, board), look_at_pictures(right, board), board, {});
    EXPECT_EQ(c.views_given, 13u);
    EXPECT_GE(c.views_used, 12u);
    EXPECT_LE(c.bundle.rms_px(), 0.19);
    EXPECT_LE(c.row_rms_px, 0.11);
    EXPECT_NEAR(c.baseline_m, 3.327, 0.003 * 3.327);
}

}  // namespace
}  // namespace vantage
