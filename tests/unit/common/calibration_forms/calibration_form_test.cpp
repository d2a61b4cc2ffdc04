#include "common/calibration_forms/calibration_form.h"

#include <cmath>
#include <cstring>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/calibration_file.h"
#include "common/config/intrinsics_file.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using testing::HasSubstr;

/// A rig whose cameras are turned against each other and have lenses of their own.
StereoCalibration some_rig(LensModel lens, std::size_t coefficients) {
    StereoCalibration rig;
    const std::vector<double> numbers{-0.2812345678901234,
                                      0.0734,
                                      0.00021,
                                      1.7e-05,
                                      0.011,
                                      0.02,
                                      -0.003,
                                      0.0004,
                                      0.00012,
                                      -3e-05,
                                      0.00017,
                                      -2e-05,
                                      0.00123,
                                      -0.0021};
    for (CameraModel* camera : {&rig.left, &rig.right}) {
        camera->width_px = 752;
        camera->height_px = 480;
        camera->lens = lens;
        camera->distortion.assign(numbers.begin(),
                                  numbers.begin() + static_cast<std::ptrdiff_t>(coefficients));
        if (lens == LensModel::fisheye)
            for (double& k : camera->distortion) k *= 0.1;
    }
    rig.left.fx_px = 458.654321012345;
    rig.left.fy_px = 457.296;
    rig.left.cx_px = 367.215;
    rig.left.cy_px = 248.375;
    rig.right.fx_px = 457.587;
    rig.right.fy_px = 456.134;
    rig.right.cx_px = 379.999;
    rig.right.cy_px = 255.238;
    rig.right_from_left.linear() =
        Eigen::AngleAxisd(0.03, Eigen::Vector3d(0.1, 1, 0.2).normalized()).toRotationMatrix();
    rig.right_from_left.translation() = Eigen::Vector3d(-0.11007379, 0.0003991, -0.00085372);
    compute_rectification(rig, 0);
    assume_place(rig);
    return rig;
}

std::vector<FormFile> files_of(const std::vector<FormText>& texts) {
    std::vector<FormFile> files;
    for (const FormText& text : texts)
        if (text.name != "points3D.txt") files.push_back(form_file_of(text.name, text.text));
    return files;
}

double farthest_projection_px(const CameraModel& a, const CameraModel& b) {
    double farthest = 0;
    for (int y = 0; y <= 4; ++y)
        for (int x = 0; x <= 4; ++x) {
            const Eigen::Vector3d point =
                a.unproject({x * (a.width_px - 1) / 4.0, y * (a.height_px - 1) / 4.0});
            farthest = std::max(farthest, (*a.project(point) - *b.project(point)).norm());
        }
    return farthest;
}

void expect_same_rig(const StereoCalibration& rig, const FormCalibration& read,
                     const std::string& form) {
    ASSERT_EQ(read.cameras.size(), 2u) << form;
    for (const bool is_left : {true, false}) {
        const CameraModel& written = is_left ? rig.left : rig.right;
        const CameraModel& back = read.cameras[is_left ? 0 : 1].model;
        EXPECT_EQ(written.width_px, back.width_px) << form;
        EXPECT_EQ(written.height_px, back.height_px) << form;
        EXPECT_EQ(written.lens, back.lens) << form;
        EXPECT_LT((written.K() - back.K()).cwiseAbs().maxCoeff(), 1e-9) << form;
        for (std::size_t i = 0; i < std::max(written.distortion.size(), back.distortion.size());
             ++i)
            EXPECT_NEAR(i < written.distortion.size() ? written.distortion[i] : 0,
                        i < back.distortion.size() ? back.distortion[i] : 0, 1e-9)
                << form;
        EXPECT_LT(farthest_projection_px(written, back), 0.01) << form;
    }
    ASSERT_TRUE(read.cameras[0].camera_from_frame && read.cameras[1].camera_from_frame) << form;
    const Pose between =
        *read.cameras[1].camera_from_frame * read.cameras[0].camera_from_frame->inverse();
    EXPECT_LT((between.matrix() - rig.right_from_left.matrix()).cwiseAbs().maxCoeff(), 1e-9)
        << form;
}

TEST(CalibrationForms, ComeBackFromEveryFormThatIsWritten) {
    int written = 0;
    for (const CalibrationForm& form : calibration_forms()) {
        if (!form.write) continue;
        ++written;
        for (const LensModel lens : {LensModel::pinhole, LensModel::fisheye}) {
            const StereoCalibration rig = some_rig(lens, 4);
            const std::vector<FormFile> files = files_of(form.write(rig));
            for (const FormFile& file : files) {
                const auto found = form_of_file(file);
                ASSERT_TRUE(found) << form.name << ' ' << file.path;
                EXPECT_EQ(found->name, form.name);
            }
            expect_same_rig(rig, form.read(files, {}), form.name);
        }
    }
    EXPECT_GE(written, 5);
}

TEST(CalibrationForms, ComeBackWithEveryNumberOfCoefficientsOrRefuseThem) {
    for (const std::size_t coefficients : {0, 4, 5, 8, 12, 14}) {
        const StereoCalibration rig = some_rig(LensModel::pinhole, coefficients);
        int written = 0;
        for (const CalibrationForm& form : calibration_forms()) {
            if (!form.write) continue;
            const auto write = [&] { return files_of(form.write(rig)); };
            if (const std::string refusal = thrown_sentence(write); !refusal.empty()) {
                EXPECT_THAT(refusal, HasSubstr("cannot be written")) << form.name;
                continue;
            }
            ++written;
            expect_same_rig(rig, form.read(write(), {}), form.name);
        }
        EXPECT_GE(written, 1) << coefficients;
    }
}

TEST(CalibrationForms, RefuseLensesThatTheyCannotExpress) {
    const StereoCalibration rig = some_rig(LensModel::pinhole, 8);
    for (const CalibrationForm& form : calibration_forms()) {
        if (!form.write) continue;
        const std::string sentence = thrown_sentence([&] { form.write(rig); });
        if (form.name == "kalibr" || form.name == "nerfstudio")
            EXPECT_THAT(sentence, HasSubstr("cannot be written")) << form.name;
        else
            expect_same_rig(rig, form.read(files_of(form.write(rig)), {}), form.name);
    }
}

FormCalibration read_one(const std::filesystem::path& name, const std::string& text,
                         const FormSettings& settings = {}) {
    const std::vector<FormFile> files{form_file_of(name, text)};
    const auto form = form_of_file(files.front());
    if (!form) fail("no form knows {}", name.string());
    return form->read(files, settings);
}

Eigen::Vector3d right_in_left(const FormCalibration& read) {
    return (*read.cameras.at(0).camera_from_frame * read.cameras.at(1).camera_from_frame->inverse())
        .translation();
}

TEST(KalibrForm, ReadsChainsAndInertialUnits) {
    const char* camera = R"(
  camera_model: pinhole
  distortion_coeffs: [-0.28, 0.07, 0.0002, 1.7e-05]
  distortion_model: radtan
  intrinsics: [458.6, 457.2, 367.2, 248.3]
  resolution: [752, 480]
  rostopic: /cam0/image_raw
)";
    const std::string pose =
        "  - [1.0, 0.0, 0.0, {}]\n  - [0.0, 1.0, 0.0, 0.0]\n"
        "  - [0.0, 0.0, 1.0, 0.0]\n  - [0.0, 0.0, 0.0, 1.0]\n";
    const FormCalibration chain =
        read_one("camchain.yaml", fmt::format("cam0:{}cam1:{}  T_cn_cnm1:\n{}", camera, camera,
                                              fmt::format(fmt::runtime(pose), -0.11)));
    EXPECT_TRUE(right_in_left(chain).isApprox(Eigen::Vector3d(0.11, 0, 0)));
    EXPECT_EQ(chain.cameras[0].model.distortion[3], 1.7e-05);
    const FormCalibration imu = read_one(
        "imucam.yaml", fmt::format("%YAML:1.0\ncam0:{}  T_imu_cam:\n{}cam1:{}  T_imu_cam:\n{}",
                                   camera, fmt::format(fmt::runtime(pose), 0.0), camera,
                                   fmt::format(fmt::runtime(pose), 0.2)));
    EXPECT_TRUE(right_in_left(imu).isApprox(Eigen::Vector3d(0.2, 0, 0)));
    EXPECT_THAT(thrown_sentence(
                    [] { read_one("a.yaml", "cam0:\n  camera_model: omni\n  intrinsics: [1]\n"); }),
                HasSubstr("'omni' is not known"));
}

TEST(OpenCvForm, ReadsBothFormsOfTheSamplesAsYamlAndXml) {
    const std::string intrinsics =
        "%YAML:1.0\n---\nM1: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 500., "
        "0., 320., 0., 501., 240., 0., 0., 1. ]\nD1: !!opencv-matrix\n   rows: 1\n   cols: 5\n   "
        "dt: d\n   data: [ 0.1, 0., 0., 0., 0. ]\nM2: !!opencv-matrix\n   rows: 3\n   cols: 3\n   "
        "dt: d\n   data: [ 510., 0., 320., 0., 511., 240., 0., 0., 1. ]\n";
    const std::string extrinsics =
        "<?xml version=\"1.0\"?>\n<opencv_storage>\n<R type_id=\"opencv-matrix\"><rows>3</rows>"
        "<cols>3</cols><dt>d</dt><data>1. 0. 0. 0. 1. 0. 0. 0. 1.</data></R>\n<T "
        "type_id=\"opencv-matrix\"><rows>3</rows><cols>1</cols><dt>d</dt><data>-60. 0. 0.</data>"
        "</T>\n</opencv_storage>\n";
    const std::vector<FormFile> files{form_file_of("intrinsics.yml", intrinsics),
                                      form_file_of("extrinsics.xml", extrinsics)};
    const auto form = form_of_file(files[1]);
    ASSERT_TRUE(form);
    EXPECT_EQ(form->name, "opencv");
    EXPECT_THAT(thrown_sentence([&] { form->read(files, {}); }), HasSubstr("--size"));
    const FormCalibration read = form->read(files, {.size_px = cv::Size(640, 480)});
    EXPECT_TRUE(right_in_left(read).isApprox(Eigen::Vector3d(60, 0, 0)));
    EXPECT_TRUE(read.unit_is_assumed);
    EXPECT_EQ(read.cameras[1].model.fy_px, 511);
    EXPECT_EQ(read.cameras[0].model.distortion[0], 0.1);
    EXPECT_THAT(thrown_sentence([&] {
                    form->read(std::span(files).first(1), {.size_px = cv::Size(640, 480)});
                }),
                HasSubstr("extrinsics"));
    const FormCalibration single = read_one(
        "camera.yml",
        "%YAML:1.0\n---\ncalibration_time: \"Sun\"\nimage_width: 640\nimage_height: 480\n"
        "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 500., 0., "
        "320., 0., 500., 240., 0., 0., 1. ]\ndistortion_coefficients: !!opencv-matrix\n   rows: "
        "5\n   cols: 1\n   dt: d\n   data: [ 0.1, 0., 0., 0., 0. ]\n");
    ASSERT_EQ(single.cameras.size(), 1u);
    EXPECT_EQ(single.cameras[0].model.width_px, 640);
}

TEST(OrbSlamForm, ReadsEveryGeneration) {
    const FormCalibration first = read_one(
        "new.yaml",
        "%YAML:1.0\nFile.version: \"1.0\"\nCamera.type: \"PinHole\"\nCamera1.fx: "
        "458.6\nCamera1.fy: "
        "457.2\nCamera1.cx: 367.2\nCamera1.cy: 248.3\nCamera1.k1: -0.28\nCamera2.fx: "
        "457.5\nCamera2.fy: 456.1\nCamera2.cx: 379.9\nCamera2.cy: 255.2\nCamera.width: "
        "752\nCamera.height: 480\nStereo.T_c1_c2: !!opencv-matrix\n  rows: 4\n  cols: 4\n  dt: "
        "f\n  data: [1,0,0,0.11,\n    0,1,0,0,\n    0,0,1,0,\n    0,0,0,1.0]\n");
    EXPECT_TRUE(right_in_left(first).isApprox(Eigen::Vector3d(0.11, 0, 0)));
    EXPECT_EQ(first.cameras[0].model.distortion[0], -0.28);
    const FormCalibration rectified =
        read_one("r.yaml",
                 "Camera.type: \"Rectified\"\nCamera1.fx: 400\nCamera1.fy: 400\nCamera1.cx: "
                 "320\nCamera1.cy: 240\nCamera.width: 640\nCamera.height: 480\nStereo.b: 0.06\n");
    EXPECT_TRUE(right_in_left(rectified).isApprox(Eigen::Vector3d(0.06, 0, 0)));
    const std::string side =
        "{0}.height: 480\n{0}.width: 752\n{0}.D: !!opencv-matrix\n   rows: 1\n   cols: 5\n   dt: "
        "d\n   data:[-0.28, 0.07, 0.0002, 1.7e-05, 0.0]\n{0}.K: !!opencv-matrix\n   rows: 3\n   "
        "cols: 3\n   dt: d\n   data: [458.6, 0.0, 367.2, 0.0, 457.2, 248.3, 0.0, 0.0, "
        "1.0]\n{0}.R:  !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [1, 0, 0, 0, 1, "
        "0, 0, 0, 1]\n{0}.P:  !!opencv-matrix\n   rows: 3\n   cols: 4\n   dt: d\n   data: [435.2, "
        "0.0, 367.4, {1}, 0.0, 435.2, 252.2, 0.0, 0.0, 0.0, 1.0, 0.0]\n";
    const FormCalibration old =
        read_one("EuRoC.yaml", "%YAML:1.0\nCamera.fx: 435.2\n" +
                                   fmt::format(fmt::runtime(side), "LEFT", "0.0") +
                                   fmt::format(fmt::runtime(side), "RIGHT", "-43.52"));
    EXPECT_TRUE(right_in_left(old).isApprox(Eigen::Vector3d(0.1, 0, 0)));
    EXPECT_EQ(old.cameras[1].model.distortion.size(), 4u);
}

TEST(DepthAiForm, FollowsItsChainOfSocketsInCentimetres) {
    const auto camera = [](int to, double x_cm) {
        return Tree{
            {"cameraType", 0},
            {"width", 1280},
            {"height", 800},
            {"intrinsicMatrix", {{800.0, 0.0, 640.0}, {0.0, 800.0, 400.0}, {0.0, 0.0, 1.0}}},
            {"distortionCoeff",
             std::vector<double>{1, -2, 0.001, 0, 3, 0.9, -1.9, 2.9, 0, 0, 0, 0, 0, 0}},
            {"extrinsics",
             {{"toCameraSocket", to},
              {"rotationMatrix", {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}},
              {"translation", {{"x", x_cm}, {"y", 0.0}, {"z", 0.0}}}}}};
    };
    // From left to right, from right to the colour camera between them.
    const Tree tree{{"boardName", "OAK-D"},
                    {"cameraData", Tree::array({Tree::array({0, camera(-1, 0)}),
                                                Tree::array({1, camera(2, -7.5)}),
                                                Tree::array({2, camera(0, 3.75)})})}};
    const FormCalibration read = read_one("oak.json", tree.dump());
    ASSERT_EQ(read.cameras.size(), 3u);
    EXPECT_FALSE(read.unit_is_assumed);
    const Pose right_from_left =
        *read.cameras[2].camera_from_frame * read.cameras[1].camera_from_frame->inverse();
    EXPECT_TRUE(right_from_left.translation().isApprox(Eigen::Vector3d(-0.075, 0, 0)));
    EXPECT_EQ(read.cameras[1].model.distortion.size(), 8u);
}

/// A socket of DepthAI whose camera stands in another one's frame.
Tree socket_camera(int to, double x, std::optional<int> length_unit = {}) {
    Tree camera{{"cameraType", 0},
                {"width", 640},
                {"height", 480},
                {"intrinsicMatrix", {{500.0, 0.0, 320.0}, {0.0, 500.0, 240.0}, {0.0, 0.0, 1.0}}},
                {"distortionCoeff", {0.1, 0.02}},
                {"extrinsics",
                 {{"toCameraSocket", to},
                  {"rotationMatrix", {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}},
                  {"translation", {{"x", x}, {"y", 0.0}, {"z", 0.0}}}}}};
    if (length_unit) camera["extrinsics"]["lengthUnit"] = *length_unit;
    return camera;
}

FormCalibration read_sockets(const std::vector<std::pair<int, Tree>>& sockets) {
    Tree data = Tree::array();
    for (const auto& [number, camera] : sockets) data.push_back(Tree::array({number, camera}));
    return read_one("oak.json", Tree{{"version", 7}, {"cameraData", data}}.dump());
}

TEST(DepthAiForm, LeavesOutCamerasWithoutALens) {
    Tree empty = socket_camera(-1, 0), bare{{"extrinsics", {{"toCameraSocket", -1}}}};
    empty["width"] = 0;
    empty["intrinsicMatrix"] = Tree::array();
    Tree equirectangular = socket_camera(1, 0);
    equirectangular["cameraType"] = 2;
    const FormCalibration read = read_sockets({{0, empty},
                                               {1, socket_camera(0, -7.5)},
                                               {2, socket_camera(0, 0)},
                                               {3, equirectangular},
                                               {4, bare}});
    ASSERT_EQ(read.cameras.size(), 2u);
    EXPECT_EQ(read.cameras[0].name, "CAM_B (left)");
    EXPECT_NEAR(right_in_left(read).norm(), 0.075, 1e-12) << "through the frame of CAM_A";
    EXPECT_THAT(read.left_out, testing::Contains(HasSubstr("'CAM_A (colour)', whose lens is not")));
    EXPECT_THAT(read.left_out, testing::Contains(HasSubstr("'CAM_D', whose projection")));
    EXPECT_THAT(read.left_out, testing::Contains(HasSubstr("'CAM_E', whose lens is not")));
}

TEST(DepthAiForm, GivesNoPlaceToCamerasOfOtherChains) {
    const FormCalibration read = read_sockets({{1, socket_camera(2, -7.5)},
                                               {2, socket_camera(-1, 0)},
                                               {3, socket_camera(-1, 0)},
                                               {4, socket_camera(5, 1)},
                                               {5, socket_camera(4, 1)}});
    ASSERT_EQ(read.cameras.size(), 5u);
    EXPECT_TRUE(read.cameras[0].camera_from_frame && read.cameras[1].camera_from_frame);
    for (std::size_t i : {2, 3, 4}) EXPECT_FALSE(read.cameras[i].camera_from_frame) << i;
    EXPECT_THAT(read.left_out, testing::Contains(HasSubstr("the place of the camera 'CAM_D'")));
}

TEST(DepthAiForm, TakesTheUnitThatTheFileStates) {
    const std::vector<double> metres{1, 0.01, 0.001, 0.0254, 0.3048};
    for (std::size_t unit = 0; unit < metres.size(); ++unit)
        EXPECT_NEAR(right_in_left(read_sockets({{1, socket_camera(2, -3, static_cast<int>(unit))},
                                                {2, socket_camera(-1, 0)}}))
                        .norm(),
                    3 * metres[unit], 1e-12);
    EXPECT_THAT(thrown_sentence([] {
                    read_sockets({{1, socket_camera(2, -3, 5)}});
                }),
                HasSubstr("'lengthUnit' is 5"));
}

/// A transforms.json with one frame and these entries beside its pose.
FormCalibration read_transforms(Tree values, const FormSettings& settings = {}) {
    values["frames"] = Tree::array({{{"file_path", "./train/r_0"},
                                     {"transform_matrix",
                                      {{1.0, 0.0, 0.0, 0.0},
                                       {0.0, 1.0, 0.0, 0.0},
                                       {0.0, 0.0, 1.0, 4.0},
                                       {0.0, 0.0, 0.0, 1.0}}}}});
    return read_one("transforms.json", values.dump(), settings);
}

TEST(NerfstudioForm, ReadsAnglesOfViewAndOtherWritersKeys) {
    // NeRF's synthetic scenes have an angle and no size.
    const Tree angle{{"camera_angle_x", 2 * std::atan(0.5)}};
    EXPECT_THAT(thrown_sentence([&] { read_transforms(angle); }), HasSubstr("--size"));
    const CameraModel synthetic =
        read_transforms(angle, {.size_px = cv::Size(800, 600)}).cameras.at(0).model;
    EXPECT_NEAR(synthetic.fx_px, 800, 1e-9);
    EXPECT_NEAR(synthetic.fy_px, 800, 1e-9);
    EXPECT_EQ(synthetic.cx_px, 399.5);
    const Tree both{{"w", 640},
                    {"h", 480},
                    {"camera_angle_x", 2 * std::atan(0.5)},
                    {"camera_angle_y", 2 * std::atan(0.25)}};
    EXPECT_NEAR(read_transforms(both).cameras.at(0).model.fy_px, 960, 1e-9);
    Tree lens{{"w", 640}, {"h", 480}, {"fl_x", 500.0}, {"k1", 0.1}, {"is_fisheye", true}};
    EXPECT_EQ(read_transforms(lens).cameras.at(0).model.lens, LensModel::fisheye);
    lens["is_fisheye"] = false;
    lens["camera_model"] = "SIMPLE_RADIAL";
    EXPECT_EQ(read_transforms(lens).cameras.at(0).model.distortion.at(0), 0.1);
    lens["camera_model"] = "EQUIRECTANGULAR";
    EXPECT_THAT(thrown_sentence([&] { read_transforms(lens); }), HasSubstr("EQUIRECTANGULAR"));
    EXPECT_THAT(thrown_sentence([] {
                    read_transforms({{"w", 640}, {"h", 480}});
                }),
                HasSubstr("no focal length"));
}

TEST(AniposeForm, ReadsTablesWithPoses) {
    const std::string camera =
        "[cam_{0}]\nname = \"{1}\"\nsize = [1280, 720]\nmatrix = [[900.0, 0.0, 640.0], [0.0, "
        "900.0, "
        "360.0], [0.0, 0.0, 1.0]]\ndistortions = [0.1, 0.0, 0.0, 0.0, 0.0]\nrotation = [0.0, {2}, "
        "0.0]\ntranslation = [{3}, 0.0, 0.0]\n";
    const FormCalibration read = read_one(
        "calibration.toml", fmt::format(fmt::runtime(camera), 0, "A", "0.0", "0.0") +
                                fmt::format(fmt::runtime(camera), 1, "B", "0.1", "-300.0") +
                                "[metadata]\nadjusted = false\n");
    ASSERT_EQ(read.cameras.size(), 2u);
    EXPECT_EQ(read.cameras[1].name, "B");
    EXPECT_NEAR(right_in_left(read).norm(), 300, 1e-9);
    EXPECT_TRUE(read.unit_is_assumed);
}

TEST(AniposeForm, ReadsTheFilesOfCaliscope) {
    const std::string lens =
        "size = [1280, 720]\nmatrix = [[900.0, 0.0, 640.0], [0.0, 900.0, 360.0], [0.0, 0.0, "
        "1.0]]\ndistortions = [[0.1, 0.0, 0.0, 0.0, 0.0]]\nerror = 0.19\n";
    // The tables of version 0.6: vectors; and of versions before: matrices, and "null".
    const FormCalibration read = read_one(
        "camera_array.toml",
        "[cameras.10]\ncam_id = 10\nrotation_count = -1\n" + lens +
            "rotation = [0.0, 0.1, 0.0]\ntranslation = [-0.3, 0.0, 0.0]\n[cameras.2]\nignore = "
            "false\n" +
            lens +
            "rotation = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]\ntranslation = [0.0, "
            "0.0, 0.0]\n[cameras.3]\nignore = true\n" +
            lens + "[cameras.4]\nmatrix = \"null\"\ndistortions = \"null\"\nrotation = \"null\"\n");
    ASSERT_EQ(read.cameras.size(), 2u);
    EXPECT_EQ(read.cameras[0].name, "cam_2");
    EXPECT_EQ(read.cameras[1].name, "cam_10");
    EXPECT_NEAR(right_in_left(read).norm(), 0.3, 1e-12);
    EXPECT_THAT(read.left_out, testing::Contains(HasSubstr("'cam_10' by -90 degrees")));
    EXPECT_THAT(read.left_out, testing::Contains(HasSubstr("'cam_3', which the file says to")));
    EXPECT_THAT(read.left_out, testing::Contains(HasSubstr("'cam_4', whose lens is not")));
    const FormCalibration without_place =
        read_one("config.toml", "[cam_1]\nport = 1\n" + lens + "rotation = \"null\"\n");
    EXPECT_FALSE(without_place.cameras.at(0).camera_from_frame);
}

/// The text of an element for a camera of this rig, as Qualisys writes them.
std::string qualisys_camera(const CameraModel& camera, const Pose& world_from_camera, int serial) {
    const Eigen::Matrix3d rows =
        Eigen::Vector3d(1, -1, -1).asDiagonal() * world_from_camera.linear().transpose();
    const Eigen::Vector3d mm = 1000 * world_from_camera.translation();
    std::string text = fmt::format(
        "<camera active=\"1\" serial=\"{}\" model=\"Miqus Video\" viewrotation=\"0\">\n"
        "<fov_video left=\"0\" top=\"0\" right=\"{}\" bottom=\"{}\"/>\n<transform x=\"{}\" "
        "y=\"{}\" z=\"{}\"",
        serial, camera.width_px - 1, camera.height_px - 1, mm.x(), mm.y(), mm.z());
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            text += fmt::format(" r{}{}=\"{}\"", row + 1, column + 1, rows(row, column));
    const std::vector<double>& d = camera.distortion;
    return text +
           fmt::format(
               "/>\n<intrinsic focallength=\"9.27\" sensorMinU=\"0\" sensorMaxU=\"{}\" "
               "sensorMinV=\"0\" sensorMaxV=\"{}\" focalLengthU=\"{}\" focalLengthV=\"{}\" "
               "centerPointU=\"{}\" centerPointV=\"{}\" skew=\"0\" radialDistortion1=\"{}\" "
               "radialDistortion2=\"{}\" radialDistortion3=\"0\" tangentalDistortion1=\"{}\" "
               "tangentalDistortion2=\"{}\"/>\n</camera>\n",
               camera.width_px * 64 - 1, camera.height_px * 64 - 1, 64 * camera.fx_px,
               64 * camera.fy_px, 64 * camera.cx_px, 64 * camera.cy_px, d[0], d[1], d[2], d[3]);
}

TEST(QualisysForm, ComesBackInMetresWithItsWorld) {
    const StereoCalibration rig = some_rig(LensModel::pinhole, 4);
    const Pose right = rig.world_from_left * rig.right_from_left.inverse();
    const std::string calibration =
        "<calibration source=\"a.qca\" type=\"regular\"><results std-dev=\"0.6\"/>\n<cameras>\n" +
        qualisys_camera(rig.left, rig.world_from_left, 21386) +
        qualisys_camera(rig.right, right, 21387) + "</cameras></calibration>\n";
    for (const std::string& text :
         {"<?xml version=\"1.0\"?>\n" + calibration,
          "<QTM_Parameters_Ver_1.25>" + calibration + "</QTM_Parameters_Ver_1.25>"}) {
        FormCalibration read = read_one("lab.qca.txt", text);
        EXPECT_FALSE(read.unit_is_assumed);
        for (FormCamera& camera : read.cameras)
            camera.camera_from_frame->translation() *= read.metres_per_unit;
        expect_same_rig(rig, read, "qualisys");
        EXPECT_EQ(read.cameras[1].name, "21387");
        EXPECT_LT(
            (read.cameras[0].camera_from_frame->inverse().matrix() - rig.world_from_left.matrix())
                .cwiseAbs()
                .maxCoeff(),
            1e-9);
    }
    // The video is a part of the sensor: 736x470 from (8, 4). Some files lack what is 0.
    std::string part = calibration;
    for (const auto& [was, becomes] :
         {std::pair{"fov_video left=\"0\" top=\"0\" right=\"751\" "
                    "bottom=\"479\"",
                    "fov_video left=\"8\" top=\"4\" right=\"743\" "
                    "bottom=\"473\""},
          std::pair{" skew=\"0\"", ""}, std::pair{" radialDistortion3=\"0\"", ""}})
        part.replace(part.find(was), std::strlen(was), becomes);
    const FormCalibration cut = read_one("lab.qca.txt", part);
    EXPECT_EQ(cut.cameras[0].model.width_px, 736);
    EXPECT_EQ(cut.cameras[0].model.height_px, 470);
    EXPECT_NEAR(cut.cameras[0].model.cx_px, rig.left.cx_px - 8, 1e-9);
    EXPECT_NEAR(cut.cameras[0].model.cy_px, rig.left.cy_px - 4, 1e-9);
    EXPECT_EQ(cut.cameras[1].model.width_px, rig.right.width_px);
    EXPECT_THAT(cut.assumed, testing::Contains(HasSubstr("736x470 from (8, 4)")));
    part.replace(part.find("right=\"743\""), 11, "right=\"843\"");
    EXPECT_THAT(thrown_sentence([&] { read_one("lab.qca.txt", part); }),
                HasSubstr("not within its sensor"));
    std::string uncalibrated = calibration;
    uncalibrated.replace(uncalibrated.find("active=\"1\""), 10, "calibrated=\"false\"");
    EXPECT_THAT(read_one("lab.qca.txt", uncalibrated).left_out,
                testing::Contains(HasSubstr("'21386', which is not calibrated")));
    std::string without = calibration;
    without.replace(without.find("r22="), 4, "q22=");
    EXPECT_THAT(thrown_sentence([&] { read_one("lab.qca.txt", without); }), HasSubstr("r22"));
}

TEST(MetashapeForm, ComesBackWithItsScaleAndOrigin) {
    StereoCalibration rig = some_rig(LensModel::pinhole, 5);
    // Metashape has one sensor for cameras with one lens.
    const auto sensor = [](int id, const CameraModel& c) {
        const std::vector<double>& d = c.distortion;
        return fmt::format(
            "<sensor id=\"{}\" label=\"unknown\" type=\"frame\"><resolution width=\"{}\" "
            "height=\"{}\"/><calibration type=\"frame\" class=\"adjusted\"><resolution "
            "width=\"{}\" height=\"{}\"/><f>{}</f><cx>{}</cx><cy>{}</cy><b1>{}</b1><k1>{}</k1>"
            "<k2>{}</k2><k3>{}</k3><p1>{}</p1><p2>{}</p2></calibration></sensor>\n",
            id, c.width_px, c.height_px, c.width_px, c.height_px, c.fy_px,
            c.cx_px + 0.5 - c.width_px / 2.0, c.cy_px + 0.5 - c.height_px / 2.0, c.fx_px - c.fy_px,
            d[0], d[1], d[4], d[3], d[2]);
    };
    constexpr double metres_per_unit = 0.25;
    const auto camera = [](int id, const Pose& place) {
        std::string numbers;
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column)
                numbers += fmt::format("{} ", column == 3 && row < 3
                                                  ? place.matrix()(row, column) / metres_per_unit
                                                  : place.matrix()(row, column));
        return fmt::format(
            "<camera id=\"{}\" sensor_id=\"{}\" component_id=\"0\" label=\"IMG {}\">"
            "<transform>{}</transform></camera>\n",
            id, id, id, numbers);
    };
    const std::string text =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<document version=\"1.5.0\">\n<chunk "
        "label=\"Chunk 1\" enabled=\"true\"><sensors next_id=\"2\">" +
        sensor(0, rig.left) + sensor(1, rig.right) +
        "</sensors><components next_id=\"1\"><component id=\"0\"><transform><rotation>1 0 0 0 1 0 "
        "0 0 1</rotation><translation>5 6 7</translation><scale>0.25</scale></transform>"
        "</component></components><cameras next_id=\"3\">" +
        camera(0, rig.world_from_left) +
        camera(1, rig.world_from_left * rig.right_from_left.inverse()) +
        "<camera id=\"2\" sensor_id=\"0\" label=\"IMG 2\"/></cameras></chunk></document>\n";
    FormCalibration read = read_one("cameras.xml", text);
    EXPECT_EQ(read.metres_per_unit, metres_per_unit);
    for (FormCamera& one : read.cameras)
        one.camera_from_frame->translation() *= read.metres_per_unit;
    expect_same_rig(rig, read, "metashape");
    EXPECT_THAT(read.left_out, testing::Contains(HasSubstr("'IMG 2', which is not aligned")));
    std::string fisheye = text;
    fisheye.replace(fisheye.find("calibration type=\"frame\""), 24, "calibration type=\"fisheye\"");
    read = read_one("cameras.xml", fisheye);
    ASSERT_EQ(read.cameras.size(), 1u) << "a lens of another type leaves out its cameras only";
    EXPECT_THAT(read.left_out, testing::Contains(HasSubstr("'fisheye'")));
    // The adjusted calibration counts, wherever it stands.
    std::string initial = text;
    initial.insert(initial.find("</sensor>"),
                   "<calibration type=\"frame\" class=\"initial\"><f>1</f></calibration>");
    EXPECT_EQ(read_one("cameras.xml", initial).cameras.at(0).model.fy_px, rig.left.fy_px);
    std::string turned = text;
    turned.insert(turned.find("</camera>"), "<orientation>6</orientation>");
    turned.replace(turned.find("label=\"IMG 2\""), 13, "master_id=\"0\"");
    read = read_one("cameras.xml", turned);
    EXPECT_THAT(read.left_out, testing::Contains(HasSubstr("the orientation 6")));
    EXPECT_THAT(read.left_out, testing::Contains(HasSubstr("'2', whose place the file states")));
}

TEST(ColmapForm, TakesHalfPixelsAndNamesWithSpaces) {
    const std::vector<FormFile> files{
        form_file_of("images.txt",
                     "# header\n1 1 0 0 0 0 0 0 1 A (1).jpg\n\n2 1 0 0 0 -0.2 0 0 1 "
                     "A (2).jpg\n1 2 -1 4 5 7\n"),
        form_file_of("cameras.txt", "1 SIMPLE_RADIAL 640 480 500 320.5 240.5 0.1\n")};
    const FormCalibration read = form_of_file(files[0])->read(files, {});
    ASSERT_EQ(read.cameras.size(), 2u);
    EXPECT_EQ(read.cameras[0].model.cx_px, 320);
    EXPECT_EQ(read.cameras[1].name, "A (2).jpg");
    EXPECT_TRUE(right_in_left(read).isApprox(Eigen::Vector3d(0.2, 0, 0)));
}

TEST(ForeignCalibration, IsNamedByEveryReaderWithTheCommandThatBringsItIn) {
    const TemporaryFolder folder;
    for (const CalibrationForm& form : calibration_forms()) {
        if (!form.write) continue;
        const FormText text = form.write(some_rig(LensModel::pinhole, 4)).front();
        const auto path = folder.path() / text.name;
        std::ofstream(path) << text.text;
        for (const std::string& sentence : {thrown_sentence([&] { load_calibration(path); }),
                                            thrown_sentence([&] { load_intrinsics(path); })}) {
            EXPECT_THAT(sentence, HasSubstr(form.program));
            EXPECT_THAT(sentence, HasSubstr("vantage-calib import " + path.string()));
        }
    }
    const auto own = folder.path() / "own.yaml";
    std::ofstream(own)
        << "%YAML:1.0\n---\nkind: \"vantage stereo calibration\"\nM1: 3\nR: 1\nT: 2\n";
    EXPECT_THAT(thrown_sentence([&] { load_calibration(own); }), testing::Not(HasSubstr("OpenCV")));
}

}  // namespace
}  // namespace vantage
