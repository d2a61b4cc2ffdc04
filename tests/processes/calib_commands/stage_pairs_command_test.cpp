#include <cmath>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/config/calibration_file.h"
#include "common/config/rig_config.h"
#include "common/config/stage_cameras.h"
#include "common/config/stage_config.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

using testing::HasSubstr;

/// Single cameras on a circle of 4 m that look at its middle, as another program's calibration.
class StagePairsCommand : public testing::Test {
  protected:
    /// Cameras at these angles; the file's world has z up and millimetres.
    void calibrate(const std::vector<double>& azimuths_deg) const {
        std::ofstream file(at("calibration.toml"));
        for (std::size_t i = 0; i < azimuths_deg.size(); ++i) {
            const double azimuth = azimuths_deg[i] * 0.017453292519943295;
            const Eigen::Vector3d eye(4000 * std::sin(azimuth), -4000 * std::cos(azimuth), 1500);
            Eigen::Matrix3d camera_from_world;
            const Eigen::Vector3d z = (Eigen::Vector3d(0, 0, 1500) - eye).normalized(), y(0, 0, -1);
            camera_from_world << y.cross(z).transpose(), y.transpose(), z.transpose();
            const Eigen::AngleAxisd turn(camera_from_world);
            const Eigen::Vector3d rotation = turn.angle() * turn.axis(),
                                  translation = -(camera_from_world * eye);
            file << fmt::format(
                "[cam_{}]\nname = \"c{}\"\nsize = [640, 480]\nmatrix = [[600.0, 0.0, 319.5], "
                "[0.0, 600.0, 239.5], [0.0, 0.0, 1.0]]\ndistortions = [0.01, 0.0, 0.0, 0.0, "
                "0.0]\nrotation = [{:.12f}, {:.12f}, {:.12f}]\ntranslation = [{:.9f}, {:.9f}, "
                "{:.9f}]\n",
                i, i, rotation.x(), rotation.y(), rotation.z(), translation.x(), translation.y(),
                translation.z());
        }
    }
    ProgramResult import_all() const {
        return run_to_end(VANTAGE_CALIB, {"import", at("calibration.toml"), "--all", "--unit", "mm",
                                          "--up", "z", "-o", at("cameras")});
    }
    ProgramResult form_pairs(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words{
            "stage", "--pairs", "auto", "--stage", at("cameras/stage.toml"), "-o", at("rigs")};
        words.insert(words.end(), more.begin(), more.end());
        return run_to_end(VANTAGE_CALIB, words);
    }
    /// Names a source for every camera, as a user does.
    void name_sources() const {
        std::stringstream text;
        text << std::ifstream(at("cameras/stage.toml")).rdbuf();
        std::string stage = text.str();
        int number = 0;
        for (std::size_t place; (place = stage.find("# source = ")) != std::string::npos;)
            stage.replace(place, stage.find('\n', place) - place,
                          fmt::format("source = \"/dev/video{}\"", number++));
        std::ofstream(at("cameras/stage.toml")) << stage;
    }
    std::string at(const std::string& name) const { return (folder_.path() / name).string(); }

    TemporaryFolder folder_;
};

TEST_F(StagePairsCommand, MakesRigsThatTheProgramsLoad) {
    calibrate({0, 8, 100});
    const ProgramResult imported = import_all();
    ASSERT_EQ(imported.status, 0) << imported.err;
    EXPECT_THAT(imported.out, HasSubstr("'c2' (640x480"));
    EXPECT_THAT(imported.out, HasSubstr("stage --pairs auto"));
    name_sources();
    const ProgramResult formed = form_pairs({"--json"});
    ASSERT_EQ(formed.status, 0) << formed.err;
    const auto json = nlohmann::json::parse(formed.out);
    ASSERT_EQ(json.at("rigs").size(), 1u);
    EXPECT_EQ(json.at("rigs")[0].at("name"), "c0-c1");
    EXPECT_NEAR(json.at("rigs")[0].at("angle_deg").get<double>(), 8, 1e-6);
    EXPECT_NEAR(json.at("rigs")[0].at("distance_m").get<double>(), 4, 1e-6);
    EXPECT_EQ(json.at("singles")[0].at("name"), "c2");

    const RigConfig rig = load_rig_config(at("rigs/c0-c1.toml"));
    EXPECT_EQ(rig.source.kind, "v4l2");
    EXPECT_EQ(rig.source.left_device, "/dev/video0");
    EXPECT_EQ(rig.source.right_device, "/dev/video1");
    const StereoCalibration calibration = load_calibration(rig.calibration);
    EXPECT_FALSE(calibration.place_is_assumed);
    EXPECT_NEAR(calibration.world_from_left.translation().y(), 1.5, 1e-6) << "y points up";
    const StageConfig stage = load_stage_config(at("rigs/stage.toml"));
    ASSERT_EQ(stage.rigs.size(), 1u);
    EXPECT_EQ(stage.rigs[0].endpoint, rig.stream.bind);
    const std::vector<SingleCamera> left = load_stage_cameras(at("rigs/stage.toml"));
    ASSERT_EQ(left.size(), 1u);
    EXPECT_EQ(left[0].name, "c2");
    EXPECT_EQ(left[0].source, "/dev/video2");
}

TEST_F(StagePairsCommand, SaysWithNumbersWhyNoRigCanBeFormed) {
    calibrate({0, 42, 100});
    ASSERT_EQ(import_all().status, 0);
    const ProgramResult formed = form_pairs();
    EXPECT_EQ(formed.status, 1);
    EXPECT_THAT(formed.err, HasSubstr("42.0 degrees between their axes, above 25"));
    EXPECT_THAT(formed.err, HasSubstr("vantage render --views"));
    EXPECT_FALSE(std::filesystem::exists(at("rigs"))) << "nothing half-written";
    EXPECT_THAT(form_pairs({"--rig", "a=b"}).err, HasSubstr("degrees"));
    EXPECT_THAT(run_to_end(VANTAGE_CALIB,
                           {"stage", "--board", "9x6", "--square-m", "0.02", "-o", at("rigs")})
                    .err,
                HasSubstr("--pairs auto"));
}

}  // namespace
}  // namespace vantage
