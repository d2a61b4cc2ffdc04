#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/config/calibration_file.h"
#include "common/image/image_file.h"
#include "tests/support/boards/rendered_stage.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

using testing::HasSubstr;

/// Two neighbours of a rendered stage with the calibrations they have in truth, filmed once: the
/// board on the floor (0), before both (1 to 4).
class StageCommandTest : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<TemporaryFolder>();
        RenderedStage stage(chessboard_pattern("9x6", 0.1), 640, 9);
        for (const int r : {0, 1}) {
            truths_[r] = stage.truth(first_rig + r);
            StereoCalibration known = truths_[r];
            known.world_from_left = Pose::Identity();
            compute_rectification(known, 0);
            CalibrationRecord record{"2026-01-01T00:00:00Z", "test", 0.02, 0.02, 12};
            CalibrationSigma::Camera lens{0.1, 0.1, 0.15, 0.15, {1e-3, 4e-3, 5e-5, 5e-5, 0}};
            record.sigma = CalibrationSigma{lens, lens, {1e-4, 1e-4, 1e-5}, {2e-5, 2e-5, 5e-5}};
            std::filesystem::create_directories(rig(r));
            save_calibration(rig(r) / "calibration.yaml", known, record);
        }
        for (int i = 0; i < 5; ++i) {
            const Pose world_from_board =
                i == 0 ? stage.board_on_floor() : stage.board_before_pair(first_rig);
            for (const int r : {0, 1})
                for (const int side : {0, 1})
                    write_grey_image(
                        rig(r) / ((side == 0 ? "left" : "right") + std::to_string(i) + ".png"),
                        stage.film(first_rig + r, side, world_from_board, {}));
        }
    }
    static void TearDownTestSuite() { folder_.reset(); }
    static std::filesystem::path rig(int r) { return folder_->path() / (r == 0 ? "A" : "B"); }

    ProgramResult stage(const std::string& square_m, std::vector<std::string> more = {}) const {
        std::vector<std::string> arguments = {"stage",
                                              "--board",
                                              "9x6",
                                              "--square-m",
                                              square_m,
                                              "--rig",
                                              "A=" + rig(0).string(),
                                              "--rig",
                                              rig(1).string(),
                                              "-o",
                                              output_,
                                              "--json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_to_end(VANTAGE_CALIB, arguments);
    }

    // The two in the middle, which see the floor best.
    static constexpr int first_rig = 1;
    static std::unique_ptr<TemporaryFolder> folder_;
    static StereoCalibration truths_[2];
    TemporaryFolder results_;
    std::string output_ = results_.path() / "world", html_ = results_.path() / "stage.html";
};

std::unique_ptr<TemporaryFolder> StageCommandTest::folder_;
StereoCalibration StageCommandTest::truths_[2];

TEST_F(StageCommandTest, places_rigs_in_the_world_of_the_floor_and_says_what_is_weak) {
    const ProgramResult result = stage("0.1", {"--floor", "0", "--html", html_});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json.at("instants_used"), 5);
    EXPECT_EQ(json.at("world"), "board on the floor");
    EXPECT_LT(json.at("rms_px"), 0.1);
    for (const int r : {0, 1}) {
        const std::filesystem::path file =
            std::filesystem::path(output_) / (r == 0 ? "A.yaml" : "B.yaml");
        const StereoCalibration placed = load_calibration(file);
        EXPECT_LT((placed.world_from_left.translation() - truths_[r].world_from_left.translation())
                      .norm(),
                  0.01)
            << r;
        EXPECT_TRUE(json.at("rigs").at(static_cast<std::size_t>(r)).at("refined"));
        EXPECT_TRUE(load_calibration_record(file).sigma);
    }
    std::ifstream page(html_);
    const std::string html{std::istreambuf_iterator<char>(page), {}};
    for (const char* part : {"The stage from above", "<svg", "Residual of every instant"})
        EXPECT_THAT(html, HasSubstr(part));
}

TEST_F(StageCommandTest, names_a_board_of_another_size_and_writes_nothing) {
    const ProgramResult result = stage("0.08");
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, HasSubstr("by its description"));
    EXPECT_FALSE(std::filesystem::exists(output_));
}

}  // namespace
}  // namespace vantage
