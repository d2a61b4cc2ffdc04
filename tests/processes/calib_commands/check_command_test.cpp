#include <filesystem>
#include <fstream>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "calib_tools/health/stage_health.h"
#include "common/colour/colour_file.h"
#include "common/config/calibration_file.h"
#include "common/gl/context/egl_context.h"
#include "common/image/image_file.h"
#include "common/virtual_stage/virtual_rig.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

using testing::HasSubstr;

/// Two rigs of the virtual stage, 30 degrees apart, filmed once.
class CheckCommandTest : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        const EglContext context;
        const ShaderLibrary shaders;
        VirtualStage stage(shaders);
        for (int i = 0; i < 2; ++i) {
            VirtualRigPlacement placement;
            placement.azimuth_rad = (i - 0.5) * 30 * std::numbers::pi / 180;
            placement.distance_m = 3.5;
            placement.baseline_m = 0.2;
            placement.width_px = 480;
            placement.height_px = 360;
            rigs_[i] = ideal_virtual_rig(placement);
            frames_[i] = VirtualRig(rigs_[i], {1.5, 4}, false)
                             .render(stage, std::chrono::seconds(2), static_cast<std::uint64_t>(i));
        }
    }

    /// Writes the rigs' folders; B's pictures through `response`.
    void write(const StereoCalibration& b, const ColourCorrection& response = {}) {
        for (int i = 0; i < 2; ++i) {
            std::filesystem::create_directories(rig(i));
            save_calibration(rig(i) / "calibration.yaml", i == 0 ? rigs_[0] : b,
                             {"2026-01-01T00:00:00Z", "test", 0.1, 0.1, 9});
            const ColourCorrection seen = i == 0 ? ColourCorrection{} : response;
            write_colour_image(rig(i) / "left0.png", seen.apply(frames_[i].left));
            write_colour_image(rig(i) / "right0.png", seen.apply(frames_[i].right));
        }
    }
    std::filesystem::path rig(int i) const { return folder_.path() / (i == 0 ? "A" : "B"); }

    ProgramResult run(const std::string& command, std::vector<std::string> more) const {
        std::vector<std::string> arguments = {
            command, "--rig", rig(0).string(), "--rig", "B=" + rig(1).string(), "--json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_to_end(VANTAGE_CALIB, arguments);
    }
    static std::string verdict(const ProgramResult& result, const std::string& what,
                               const std::string& rigs) {
        const auto json = nlohmann::json::parse(result.out);
        for (const auto& m : json.at("measures"))
            if (m.at("what") == what && m.at("rigs") == rigs)
                return m.at("verdict").get<std::string>() + " " + m.dump();
        return "none";
    }
    static StereoCalibration moved(StereoCalibration c) {
        c.world_from_left.translation() += Eigen::Vector3d(0.3, 0, 0.3);
        return c;
    }
    static StereoCalibration bent(StereoCalibration c) {
        c.rectified_from_right =
            Eigen::AngleAxisd(0.006, Eigen::Vector3d::UnitX()).toRotationMatrix();
        return c;
    }

    static StereoCalibration rigs_[2];
    static VirtualStereoFrame frames_[2];
    TemporaryFolder folder_;
};

StereoCalibration CheckCommandTest::rigs_[2];
VirtualStereoFrame CheckCommandTest::frames_[2];

TEST_F(CheckCommandTest, NamesACalibrationFileThatIsMissing) {
    const std::string file = (folder_.path() / "world" / "A.yaml").string(),
                      stage = (folder_.path() / "stage.toml").string();
    std::ofstream(stage)
        << "version = 1\n[[rigs]]\nname = \"A\"\nendpoint = \"tcp://127.0.0.1:9\"\n";
    const ProgramResult result =
        run_to_end(VANTAGE_CALIB, {"check", "--live", stage, "--rig", "A=" + file});
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("cannot read " + file + ": "));
}

TEST_F(CheckCommandTest, finds_a_good_stage_good_and_keeps_a_history) {
    write(rigs_[1]);
    const std::string html = folder_.path() / "health.html", history = folder_.path() / "h.jsonl";
    for (int time = 0; time < 2; ++time) {
        const ProgramResult result = run("check", {"--html", html, "--history", history});
        ASSERT_EQ(result.status, 0) << result.err;
        EXPECT_EQ(nlohmann::json::parse(result.out).at("verdict"), "good") << result.out;
    }
    std::ifstream lines(history);
    EXPECT_EQ(std::count(std::istreambuf_iterator<char>(lines), {}, '\n'), 2);
    std::ifstream page(html);
    const std::string text{std::istreambuf_iterator<char>(page), {}};
    for (const char* part : {"History of 2 checks", "<svg", "The stage is good", "% of depth"})
        EXPECT_THAT(text, HasSubstr(part));
}

TEST_F(CheckCommandTest, tells_a_bent_rig_from_a_moved_one_and_from_odd_colours) {
    write(bent(rigs_[1]));
    ProgramResult result = run("check", {});
    ASSERT_EQ(result.status, 1) << result.err;
    EXPECT_THAT(result.err, HasSubstr("the stage is bad: the rows of rig B miss each other"));
    EXPECT_THAT(verdict(result, "rows", "A"), HasSubstr("good"));
    EXPECT_THAT(verdict(result, "rows", "B"), testing::StartsWith("bad"));

    write(moved(rigs_[1]));
    result = run("check", {});
    ASSERT_EQ(result.status, 1) << result.err;
    EXPECT_THAT(result.err, HasSubstr("of the surfaces that rig"));
    EXPECT_THAT(verdict(result, "rows", "B"), testing::StartsWith("good"));
    EXPECT_THAT(verdict(result, "through", "A-B"), testing::StartsWith("bad"));

    ColourCorrection odd;
    odd.matrix = Eigen::Vector3d(0.8, 1, 0.65).asDiagonal();
    write(rigs_[1], odd);
    result = run("check", {});
    ASSERT_EQ(result.status, 1) << result.err;
    EXPECT_THAT(result.err, HasSubstr("in colours"));
    EXPECT_THAT(verdict(result, "colour", "A-B"), testing::StartsWith("bad"));
    EXPECT_THAT(verdict(result, "depth", "A-B"), testing::StartsWith("good"));

    result = run("colour", {"-o", folder_.path() / "colours"});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto b = nlohmann::json::parse(result.out).at("rigs").at(1);
    EXPECT_GT(b.at("delta_e_before"), 5);
    EXPECT_LT(b.at("delta_e_after"), 0.5 * b.at("delta_e_before").get<double>());
    EXPECT_NEAR(load_colour(folder_.path() / "colours" / "B.colour.toml").matrix(2, 2), 1 / 0.65,
                0.15);
}

TEST_F(CheckCommandTest, notices_a_rig_that_panned_or_moved_along_the_line_to_the_other) {
    // Nearly all that still agrees is the wall behind, where depth is too coarse to tell.
    StereoCalibration panned = rigs_[1];
    panned.world_from_left =
        panned.world_from_left * Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY());
    StereoCalibration slid = rigs_[1];
    slid.world_from_left.translation() += Eigen::Vector3d(0.3, 0, 0);
    for (const StereoCalibration& b : {panned, slid}) {
        write(b);
        const ProgramResult result = run("check", {});
        ASSERT_EQ(result.status, 1) << result.err;
        EXPECT_EQ(nlohmann::json::parse(result.out).at("verdict"), "bad") << result.out;
        EXPECT_THAT(result.err, HasSubstr("one of them has been moved"));
    }
}

TEST_F(CheckCommandTest, sees_one_surface_at_two_depths_where_a_rig_was_lifted) {
    StereoCalibration lifted = rigs_[1];
    lifted.world_from_left.translation() += Eigen::Vector3d(0, 0.1, 0);
    write(lifted);
    const ProgramResult result = run("check", {});
    EXPECT_THAT(verdict(result, "depth", "A-B"),
                testing::AnyOf(testing::StartsWith("bad"), testing::StartsWith("warn")));
}

TEST_F(CheckCommandTest, names_rigs_one_of_which_was_knocked_by_half_a_degree_or_a_centimetre) {
    const Pose world_from_b = rigs_[1].world_from_left;
    for (const int i : {0, 2}) {
        const Eigen::Vector3d axis = Eigen::Vector3d::Unit(i);
        StereoCalibration turned = rigs_[1];
        turned.world_from_left = world_from_b * Eigen::AngleAxisd(0.00873, axis);
        write(turned);
        const ProgramResult result = run("check", {});
        EXPECT_THAT(verdict(result, "place", "A-B"),
                    testing::AnyOf(testing::StartsWith("warn"), testing::StartsWith("bad")));
    }
    StereoCalibration lifted = rigs_[1];
    lifted.world_from_left.translation() += Eigen::Vector3d(0, 0.01, 0);
    write(lifted);
    const ProgramResult result = run("check", {});
    EXPECT_THAT(verdict(result, "place", "A-B"), testing::StartsWith("warn"));
    EXPECT_THAT(result.out, HasSubstr("moved or turned"));
}

TEST_F(CheckCommandTest, a_stage_of_which_too_little_is_seen_is_unknown_and_not_good) {
    // By its file B looks the other way, and what the two see is never one surface.
    StereoCalibration away = rigs_[1];
    away.world_from_left = away.world_from_left * Eigen::AngleAxisd(3.1, Eigen::Vector3d::UnitY());
    write(away);
    const std::string html = folder_.path() / "health.html";
    ProgramResult result = run("check", {"--html", html});
    EXPECT_EQ(result.status, 3);
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json.at("verdict"), "unknown");
    EXPECT_THAT(verdict(result, "rows", "B"), testing::StartsWith("good"));
    EXPECT_EQ(json.at("not_known").size(), 4u) << result.out;
    for (const char* part : {"depth: nothing ties B to A", "colour: nothing ties B to A"})
        EXPECT_THAT(result.err, HasSubstr(part));
    std::ifstream page(html);
    EXPECT_THAT((std::string{std::istreambuf_iterator<char>(page), {}}),
                HasSubstr("The stage is unknown"));

    write(rigs_[1]);
    write_colour_image(rig(1) / "left0.png", ColourImage(360, 480, cv::Vec4b(90, 90, 90, 255)));
    write_colour_image(rig(1) / "right0.png", ColourImage(360, 480, cv::Vec4b(90, 90, 90, 255)));
    result = run("check", {});
    EXPECT_EQ(result.status, 3);
    EXPECT_EQ(nlohmann::json::parse(result.out).at("verdict"), "unknown");
    EXPECT_THAT(result.err, HasSubstr("rows of B: unknown, too few features"));
}

HealthMeasure measure(const std::string& what, const std::string& rigs, Verdict verdict) {
    HealthMeasure measure;
    measure.what = what;
    measure.rigs = rigs;
    measure.verdict = verdict;
    return measure;
}

StageHealth health_of_three_rigs(Verdict of_ab, Verdict of_bc, Verdict of_ac) {
    StageHealth health;
    health.rig_names = {"A", "B", "C"};
    for (const std::string& rig : health.rig_names)
        health.measures.push_back(measure("rows", rig, Verdict::good));
    for (const char* what : {"depth", "through", "place", "colour"}) {
        health.measures.push_back(measure(what, "A-B", of_ab));
        health.measures.push_back(measure(what, "B-C", of_bc));
        health.measures.push_back(measure(what, "A-C", of_ac));
    }
    return health;
}

TEST(StageHealth, is_good_where_known_pairs_tie_all_rigs_and_no_pair_is_worse) {
    using enum Verdict;
    EXPECT_EQ(health_of_three_rigs(good, good, unknown).verdict(), good);
    EXPECT_EQ(health_of_three_rigs(unknown, good, good).verdict(), good);
    EXPECT_EQ(health_of_three_rigs(good, unknown, unknown).verdict(), unknown);
    EXPECT_EQ(health_of_three_rigs(warn, unknown, unknown).verdict(), warn);
    EXPECT_EQ(health_of_three_rigs(good, bad, warn).verdict(), bad);
    StageHealth health = health_of_three_rigs(good, good, good);
    EXPECT_THAT(health.not_known(), testing::IsEmpty());
    health.measures[2].verdict = unknown;
    health.measures[2].sentence = "rows of C are unknown";
    EXPECT_EQ(health.verdict(), unknown);
    EXPECT_THAT(health.not_known(), testing::ElementsAre("rows of C are unknown"));
    EXPECT_THAT(health_of_three_rigs(unknown, good, unknown).not_known(),
                testing::Contains(HasSubstr("depth: nothing ties B, C to A")));
}

TEST_F(CheckCommandTest, refuses_damaged_files_in_one_sentence) {
    write(rigs_[1]);
    std::ofstream(folder_.path() / "h.jsonl") << "{\"version\": 1}\n";
    const ProgramResult history = run("check", {"--history", folder_.path() / "h.jsonl"});
    EXPECT_EQ(history.status, 1);
    EXPECT_THAT(history.err, HasSubstr("h.jsonl:1"));
    std::ofstream(rig(1) / "calibration.yaml") << "%YAML:1.0\n---\nversion: [";
    const ProgramResult damaged = run("check", {});
    EXPECT_EQ(damaged.status, 1);
    EXPECT_EQ(damaged.out, "");
    EXPECT_THAT(damaged.err, HasSubstr("calibration.yaml"));
}

TEST_F(CheckCommandTest, names_a_picture_of_another_resolution) {
    write(rigs_[1]);
    write_colour_image(rig(1) / "left0.png", ColourImage(47, 61, cv::Vec4b(1, 2, 3, 255)));
    const ProgramResult result = run("check", {});
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("61x47"));
    EXPECT_THAT(result.err, HasSubstr("480x360"));
}

}  // namespace
}  // namespace vantage
