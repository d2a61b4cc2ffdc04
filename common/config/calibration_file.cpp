#include "common/config/calibration_file.h"

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "common/config/yaml/camera_yaml.h"
#include "common/config/yaml/number_checksum.h"

namespace vantage {
namespace {

constexpr YamlKind file_kind{"vantage stereo calibration", "a calibration of Vantage", 2};
constexpr const char* file_units =
    "lengths in metres; pictures in pixels, pixel centres at integers, origin top-left; cameras x "
    "right, y down, z forward; rotations as matrices; distortion in OpenCV's order";

void add_numbers(NumberChecksum& hash, const StereoCalibration& c) {
    hash.add(c.left);
    hash.add(c.right);
    hash.add(c.right_from_left);
    const RectifiedStereo& r = c.rectified;
    for (const double value : {static_cast<double>(r.width_px), static_cast<double>(r.height_px),
                               r.f_px, r.cx_left_px, r.cx_right_px, r.cy_px, r.baseline_m})
        hash.add(value);
    hash.add_rows(c.rectified_from_left);
    hash.add_rows(c.rectified_from_right);
    hash.add(c.world_from_left);
}

/// The checksum over all numbers of a file. Files of version 1 used the calibration's own checksum,
/// which leaves out the uncertainties.
std::string file_checksum(const StereoCalibration& c, const CalibrationRecord& record) {
    NumberChecksum hash;
    add_numbers(hash, c);
    hash.add(c.place_is_assumed ? 1 : 0);
    for (const double value :
         {record.rms_px, record.row_rms_px, static_cast<double>(record.views_used), record.alpha})
        hash.add(value);
    hash.add(record.sigma ? 1 : 0);
    if (record.sigma) {
        hash.add(record.sigma->left);
        hash.add(record.sigma->right);
        hash.add_rows(record.sigma->rotation_rad);
        hash.add_rows(record.sigma->translation_m);
    }
    return hash.hex();
}

// Writing ------------------------------------------------------------------------------------

void write_camera(cv::FileStorage& file, const char* name, const CameraModel& camera) {
    file << name << "{";
    file << "width_px" << camera.width_px << "height_px" << camera.height_px;
    file << "lens" << lens_name(camera.lens) << "K" << to_yaml_matrix(camera.K());
    file << "distortion" << to_yaml_row(camera.distortion);
    file << "}";
}

void write_sigma(cv::FileStorage& file, const CalibrationSigma& sigma) {
    file << "sigma"
         << "{";
    for (const bool is_left : {true, false}) {
        file << (is_left ? "left" : "right") << "{";
        write_lens_sigma(file, is_left ? sigma.left : sigma.right);
        file << "}";
    }
    file << "right_from_left"
         << "{"
         << "rotation_rad" << to_yaml_matrix(sigma.rotation_rad) << "translation_m"
         << to_yaml_matrix(sigma.translation_m) << "}";
    file << "}";
}

std::string to_yaml(const StereoCalibration& c, const CalibrationRecord& record) {
    cv::FileStorage file("calibration.yaml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
    file << "kind" << file_kind.kind << "version" << file_kind.version << "units" << file_units;
    file << "date" << record.date << "tool" << record.tool;
    file << "rms_px" << record.rms_px << "row_rms_px" << record.row_rms_px << "views_used"
         << record.views_used;
    file << "alpha" << record.alpha;
    file << "checksum" << checksum_text(file_checksum(c, record));
    write_camera(file, "left", c.left);
    write_camera(file, "right", c.right);
    file << "right_from_left"
         << "{"
         << "rotation" << to_yaml_matrix(Eigen::Matrix3d(c.right_from_left.linear()))
         << "translation_m" << to_yaml_matrix(Eigen::Vector3d(c.right_from_left.translation()))
         << "}";
    const RectifiedStereo& r = c.rectified;
    file << "rectified"
         << "{"
         << "width_px" << r.width_px << "height_px" << r.height_px << "f_px" << r.f_px
         << "cx_left_px" << r.cx_left_px << "cx_right_px" << r.cx_right_px << "cy_px" << r.cy_px
         << "baseline_m" << r.baseline_m << "rectified_from_left"
         << to_yaml_matrix(c.rectified_from_left) << "rectified_from_right"
         << to_yaml_matrix(c.rectified_from_right) << "}";
    file << "world_from_left"
         << "{"
         << "rotation" << to_yaml_matrix(Eigen::Matrix3d(c.world_from_left.linear()))
         << "translation_m" << to_yaml_matrix(Eigen::Vector3d(c.world_from_left.translation()))
         << "}";
    file << "place_is_assumed" << (c.place_is_assumed ? 1 : 0);
    if (record.sigma) write_sigma(file, *record.sigma);
    return file.releaseAndGetString();
}

// Reading ------------------------------------------------------------------------------------

CameraModel read_camera(const YamlSection& s) {
    CameraModel camera;
    camera.width_px = s.integer("width_px");
    camera.height_px = s.integer("height_px");
    read_lens(s, "K", "distortion", camera);
    return camera;
}

StereoCalibration read_calibration(const YamlSection& top) {
    StereoCalibration c;
    c.left = read_camera(top.section("left"));
    c.right = read_camera(top.section("right"));
    c.right_from_left = top.pose("right_from_left");
    const YamlSection r = top.section("rectified");
    c.rectified = {.width_px = r.integer("width_px"),
                   .height_px = r.integer("height_px"),
                   .f_px = r.number("f_px"),
                   .cx_left_px = r.number("cx_left_px"),
                   .cx_right_px = r.number("cx_right_px"),
                   .cy_px = r.number("cy_px"),
                   .baseline_m = r.number("baseline_m")};
    c.rectified_from_left = r.matrix3("rectified_from_left");
    c.rectified_from_right = r.matrix3("rectified_from_right");
    c.world_from_left = top.pose("world_from_left");
    c.validate();
    return c;
}

CalibrationSigma read_sigma(const YamlSection& s, const StereoCalibration& calibration) {
    CalibrationSigma sigma;
    sigma.left = read_lens_sigma(s.section("left"), calibration.left.distortion.size());
    sigma.right = read_lens_sigma(s.section("right"), calibration.right.distortion.size());
    const YamlSection pose = s.section("right_from_left");
    sigma.rotation_rad = pose.vector3("rotation_rad");
    sigma.translation_m = pose.vector3("translation_m");
    return sigma;
}

CalibrationRecord read_record(const YamlSection& top, const StereoCalibration& calibration) {
    CalibrationRecord record = {.date = top.text("date"),
                                .tool = top.text("tool"),
                                .rms_px = top.number("rms_px"),
                                .row_rms_px = top.number("row_rms_px"),
                                .views_used = top.integer("views_used")};
    // Files of version 1 had neither.
    if (!top.node["alpha"].empty()) record.alpha = top.number("alpha");
    if (!top.node["sigma"].empty()) record.sigma = read_sigma(top.section("sigma"), calibration);
    return record;
}

struct Contents {
    StereoCalibration calibration;
    CalibrationRecord record;
};

Contents read_contents(const YamlSection& top) {
    Contents contents{read_calibration(top), {}};
    StereoCalibration& c = contents.calibration;
    contents.record = read_record(top, c);
    c.id = calibration_checksum(c);
    if (top.integer("version") > 1) {
        c.place_is_assumed = top.integer("place_is_assumed") != 0;
        require_checksum(top.text("checksum"), file_checksum(c, contents.record));
        return contents;
    }
    require_checksum(top.text("checksum"), c.id);
    // Version 1 stored the identity for an unknown pose, and also for the first rig of a stage.
    if (contents.record.tool != "vantage-calib stage" &&
        c.world_from_left.matrix() == Pose::Identity().matrix())
        assume_place(c);
    return contents;
}

}  // namespace

std::string calibration_checksum(const StereoCalibration& calibration) {
    NumberChecksum hash;
    add_numbers(hash, calibration);
    return hash.hex();
}

StereoCalibration load_calibration(const std::filesystem::path& path) {
    return read_yaml(path, file_kind, read_contents).calibration;
}

CalibrationRecord load_calibration_record(const std::filesystem::path& path) {
    return read_yaml(path, file_kind, read_contents).record;
}

void save_calibration(const std::filesystem::path& path, StereoCalibration calibration,
                      const CalibrationRecord& record) {
    calibration.validate();
    calibration.id = calibration_checksum(calibration);
    write_yaml_keeping_last(path, to_yaml(calibration, record), load_calibration);
}

}  // namespace vantage
