#include "calib_tools/interchange/calibration_import.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "calib_tools/health/row_tracking.h"
#include "common/base/counted.h"
#include "common/base/error.h"
#include "common/board/median.h"
#include "common/geometry/pair_aim.h"
#include "common/geometry/rectification_map.h"
#include "common/image/image_file.h"
#include "common/rectification/rectify_reference.h"

namespace vantage {
namespace {

/// Plausible range of a rig's baseline; a distance outside it is in another unit.
constexpr double least_baseline_m = 0.004, most_baseline_m = 3;

std::string names_of(const std::vector<FormCamera>& cameras) {
    constexpr std::size_t most_listed = 12;
    std::vector<std::string> names;
    for (const FormCamera& camera : cameras)
        if (names.size() < most_listed) names.push_back(camera.name);
    const std::size_t rest = cameras.size() - names.size();
    return fmt::format("{}{}", fmt::join(names, ", "),
                       rest > 0 ? fmt::format(" and {} more", rest) : "");
}

std::string in_small_letters(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

/// The cameras whose names contain this word.
std::vector<const FormCamera*> cameras_with(const std::vector<FormCamera>& cameras,
                                            const std::string& word) {
    std::vector<const FormCamera*> found;
    for (const FormCamera& camera : cameras)
        if (in_small_letters(camera.name).find(in_small_letters(word)) != std::string::npos)
            found.push_back(&camera);
    return found;
}

/// The camera of this name, or the only one whose name contains it, such as a path's last part.
const FormCamera& camera_named(const std::vector<FormCamera>& cameras, const std::string& name,
                               const char* option) {
    for (const FormCamera& camera : cameras)
        if (camera.name == name) return camera;
    const std::vector<const FormCamera*> found = cameras_with(cameras, name);
    if (found.size() == 1) return *found.front();
    fail("{} '{}' for {}: the files have {}",
         found.empty() ? "there is no camera" : "several cameras have names with", name, option,
         names_of(cameras));
}

struct ChosenPair {
    FormCamera left, right;
    Pose right_from_left;  ///< in the unit of the file
};

Pose pose_between(const FormCamera& left, const FormCamera& right) {
    for (const FormCamera* camera : {&left, &right})
        if (!camera->camera_from_frame)
            fail(
                "the files do not say where the camera '{}' stands: give the file with the pose "
                "between the cameras too",
                camera->name);
    return *right.camera_from_frame * left.camera_from_frame->inverse();
}

/// Position of the other camera in the first one's frame.
Eigen::Vector3d place_of(const Pose& other_from_first) {
    return other_from_first.inverse().translation();
}

void require_side_by_side(const FormCamera& left, const FormCamera& right, const Pose& pose) {
    const Eigen::Vector3d place = place_of(pose);
    if (std::abs(place.y()) > std::abs(place.x()))
        fail(
            "the cameras '{}' and '{}' stand above each other ({:.3g} down, {:.3g} to the right): "
            "a rig needs them side by side",
            left.name, right.name, place.y(), place.x());
    constexpr double most_angle_rad = 0.7;
    const double angle = Eigen::AngleAxisd(Eigen::Matrix3d(pose.linear())).angle();
    if (angle > most_angle_rad)
        fail(
            "the cameras '{}' and '{}' look {:.0f} degrees apart, more than {:.0f}: they are no "
            "stereo rig",
            left.name, right.name, angle * 57.29578, most_angle_rad * 57.29578);
}

ChosenPair choose_pair(const std::vector<FormCamera>& cameras, const ImportSettings& settings) {
    if (settings.left.empty() != settings.right.empty())
        fail("give both --left and --right, or neither: the files have {}", names_of(cameras));
    const FormCamera *left = nullptr, *right = nullptr;
    const bool are_named = !settings.left.empty();
    if (are_named) {
        left = &camera_named(cameras, settings.left, "--left");
        right = &camera_named(cameras, settings.right, "--right");
        if (left == right) fail("--left and --right name the same camera, '{}'", left->name);
    } else if (cameras.size() == 2) {
        left = &cameras[0];
        right = &cameras[1];
    } else {
        const auto lefts = cameras_with(cameras, "left"), rights = cameras_with(cameras, "right");
        if (lefts.size() == 1 && rights.size() == 1) {
            left = lefts.front();
            right = rights.front();
        }
        if (!left || left == right)
            fail(
                "the files have {} cameras: name the two of the rig with --left and --right; they "
                "are {}",
                cameras.size(), names_of(cameras));
    }
    Pose pose = pose_between(*left, *right);
    if (place_of(pose).x() < 0) {
        if (are_named)
            fail("'{}' stands to the left of '{}': swap --left and --right", right->name,
                 left->name);
        std::swap(left, right);
        pose = pose.inverse();
    }
    require_side_by_side(*left, *right, pose);
    return {*left, *right, pose};
}

/// Converts the pose to metres and reports where the scale came from.
void set_scale(Pose& pose, const FormCalibration& read, const ImportSettings& settings,
               ImportedCalibration& result) {
    const double length = pose.translation().norm();
    if (!(length > 0)) fail("the two cameras stand at one place: their distance is 0");
    if (settings.baseline_m > 0) {
        pose.translation() *= settings.baseline_m / length;
        result.assumed.push_back(fmt::format(
            "the distance between the cameras as it was stated, {} m", settings.baseline_m));
        return;
    }
    const bool is_stated = settings.metres_per_unit > 0;
    const double scale = is_stated ? settings.metres_per_unit : read.metres_per_unit;
    pose.translation() *= scale;
    if (!read.unit_is_assumed || is_stated) return;
    if (const double baseline_m = length * scale;
        baseline_m < least_baseline_m || baseline_m > most_baseline_m)
        fail(
            "the file states no unit of length, and in metres the cameras would be {:.4g} m "
            "apart: say --unit mm, cm or inch, or the measured distance as --baseline-m METRES",
            baseline_m);
    result.assumed.emplace_back(
        "lengths in metres, since the file states no unit (--unit and --baseline-m say another)");
}

std::string lens_in_words(const FormCamera& camera) {
    const CameraModel& m = camera.model;
    return fmt::format("'{}' ({}x{}, f {:.2f} px, {} lens, {})", camera.name, m.width_px,
                       m.height_px, m.fx_px, m.lens == LensModel::fisheye ? "fisheye" : "pinhole",
                       counted(m.distortion.size(), "coefficient"));
}

void require_plausible(const FormCamera& camera) {
    const CameraModel& m = camera.model;
    m.validate();
    const double size = std::max(m.width_px, m.height_px);
    if (!(m.fx_px > 0.1 * size && m.fx_px < 50 * size))
        fail(
            "the camera '{}' has a focal length of {} px for pictures of {}x{}: the file is of "
            "other pictures, or holds no calibration",
            camera.name, m.fx_px, m.width_px, m.height_px);
}

struct ReadCalibration {
    CalibrationForm form;
    FormCalibration read;
};

ReadCalibration read_calibration(std::span<const FormFile> files, const ImportSettings& settings) {
    const std::optional<CalibrationForm> form = form_of_file(files.front());
    if (!form) {
        std::vector<std::string> known;
        for (const CalibrationForm& other : calibration_forms()) known.push_back(other.program);
        fail("{} is no calibration that is known; these are: {}", files.front().path.string(),
             fmt::join(known, "; "));
    }
    for (const FormFile& file : files)
        if (const auto other = form_of_file(file); !other || other->name != form->name)
            fail("{} is a calibration of {}, and {} is not: give the files of one calibration",
                 files.front().path.string(), form->program, file.path.string());
    FormCalibration read = form->read(files, settings.form);
    if (read.cameras.empty())
        fail("{} holds no camera that can be taken; left out: {}", files.front().path.string(),
             fmt::join(read.left_out, "; "));
    return {*form, std::move(read)};
}

/// Rotation from a world with this axis up to one with y up.
Eigen::Matrix3d upright_from(const std::string& up) {
    Eigen::Vector3d axis = Eigen::Vector3d::Zero();
    axis[up.back() - 'x'] = up.starts_with('-') ? -1 : 1;
    const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
    // A half turn has no unique axis.
    if (axis.dot(y) < -0.5) return Eigen::Vector3d(1, -1, -1).asDiagonal();
    return Eigen::Quaterniond::FromTwoVectors(axis, y).toRotationMatrix();
}

/// The name with other characters than letters, digits, '-' and '_' replaced by '_'.
std::string stage_name_of(const std::string& name, const std::vector<SingleCamera>& others) {
    constexpr std::size_t longest = 60;
    std::string result = name.substr(0, longest);
    for (char& c : result)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') c = '_';
    if (result.empty()) result = "camera";
    const auto is_taken = [&](const std::string& candidate) {
        return std::any_of(others.begin(), others.end(),
                           [&](const SingleCamera& other) { return other.name == candidate; });
    };
    std::string free = result;
    for (int i = 2; is_taken(free); ++i) free = fmt::format("{}_{}", result, i);
    return free;
}

}  // namespace

ImportedCalibration import_calibration(std::span<const FormFile> files,
                                       const ImportSettings& settings) {
    const auto [form, read] = read_calibration(files, settings);
    ImportedCalibration result;
    result.program = form.program;
    result.left_out = read.left_out;
    result.assumed = read.assumed;
    if (read.cameras.size() == 1) {
        require_plausible(read.cameras.front());
        result.camera = read.cameras.front().model;
        result.taken.push_back("the camera " + lens_in_words(read.cameras.front()));
        return result;
    }
    ChosenPair pair = choose_pair(read.cameras, settings);
    require_plausible(pair.left);
    require_plausible(pair.right);
    set_scale(pair.right_from_left, read, settings, result);
    StereoCalibration rig;
    rig.left = pair.left.model;
    rig.right = pair.right.model;
    rig.right_from_left = pair.right_from_left;
    if (rig.left.width_px != rig.right.width_px || rig.left.height_px != rig.right.height_px)
        fail(
            "'{}' takes pictures of {}x{} and '{}' of {}x{}: both cameras of a rig must run at "
            "one resolution",
            pair.left.name, rig.left.width_px, rig.left.height_px, pair.right.name,
            rig.right.width_px, rig.right.height_px);
    compute_rectification(rig, settings.alpha);
    const double far_m = suitable_far_m(rig);
    compute_rectification_to(rig, settings.alpha, far_m);
    assume_place(rig);
    result.camera = rig.left;
    result.taken = {
        "left: " + lens_in_words(pair.left), "right: " + lens_in_words(pair.right),
        fmt::format("they stand {:.5g} m apart", rig.right_from_left.translation().norm())};
    if (std::isfinite(far_m))
        result.assumed.push_back(fmt::format(
            "nothing beyond {:.3g} m is to be measured: the cameras are toed in by {:.1f} degrees, "
            "and each side has its own principal point",
            far_m, aim_of(rig).toe_in_deg));
    for (const FormCamera& camera : read.cameras)
        if (camera.name != pair.left.name && camera.name != pair.right.name &&
            read.cameras.size() < 12)
            result.left_out.push_back(fmt::format("the camera '{}'", camera.name));
    result.rig = rig;
    return result;
}

ImportedCameras import_cameras(std::span<const FormFile> files, const ImportSettings& settings,
                               const std::string& up) {
    const auto [form, read] = read_calibration(files, settings);
    ImportedCameras result;
    result.program = form.program;
    result.left_out = read.left_out;
    std::erase_if(result.left_out, [](const std::string& sentence) {
        return sentence.find("place of the cameras") != std::string::npos;
    });
    result.assumed = read.assumed;
    const bool is_stated = settings.metres_per_unit > 0;
    const double scale = is_stated ? settings.metres_per_unit : read.metres_per_unit;
    if (read.unit_is_assumed && !is_stated)
        result.assumed.emplace_back(
            "lengths in metres, since the file states no unit (--unit says another)");
    result.assumed.push_back(
        fmt::format("the axis {} of the file's world points up (--up says another)", up));
    const Eigen::Matrix3d upright = upright_from(up);
    for (const FormCamera& read_camera : read.cameras) {
        require_plausible(read_camera);
        if (!read_camera.camera_from_frame)
            fail("{} does not say where the camera '{}' stands, and single cameras need a place",
                 files.front().path.string(), read_camera.name);
        SingleCamera camera;
        camera.name = stage_name_of(read_camera.name, result.cameras);
        camera.model = read_camera.model;
        camera.world_from_camera = read_camera.camera_from_frame->inverse();
        camera.world_from_camera.linear() = upright * camera.world_from_camera.linear();
        camera.world_from_camera.translation() =
            scale * (upright * camera.world_from_camera.translation());
        result.taken.push_back("the camera " + lens_in_words(read_camera));
        result.cameras.push_back(std::move(camera));
    }
    return result;
}

RowAgreement check_rows(const StereoCalibration& calibration, const ColourImage& raw_left,
                        const ColourImage& raw_right) {
    const auto rectified = [&](const ColourImage& raw, Side side) {
        const CameraModel& camera = side == Side::left ? calibration.left : calibration.right;
        if (raw.cols != camera.width_px || raw.rows != camera.height_px)
            fail("the {} picture is {}x{} and the calibration is for {}x{}",
                 side == Side::left ? "left" : "right", raw.cols, raw.rows, camera.width_px,
                 camera.height_px);
        return to_grey(rectify_reference(raw, make_rectification_map(calibration, side)));
    };
    constexpr int most_features = 800;
    constexpr std::size_t least_features = 12;
    const std::vector<TrackedRow> rows = track_rows(
        rectified(raw_left, Side::left), rectified(raw_right, Side::right), most_features);
    if (rows.size() < least_features)
        fail(
            "only {} of the features of the left picture are in the right one within 6 rows of "
            "their own, too few to judge: the calibration does not fit these pictures, or they "
            "show little texture",
            rows.size());
    std::vector<double> misses, offsets;
    double squares = 0;
    for (const TrackedRow& row : rows) {
        offsets.push_back(row.row_miss_px);
        misses.push_back(std::abs(row.row_miss_px));
        squares += row.row_miss_px * row.row_miss_px;
    }
    return {rows.size(), median(misses), std::sqrt(squares / static_cast<double>(rows.size())),
            median(offsets)};
}

std::optional<double> correct_row_offset(StereoCalibration& calibration, double alpha,
                                         const ColourImage& raw_left, const ColourImage& raw_right,
                                         RowAgreement& rows) {
    constexpr double least_offset_px = 0.5, most_left_over = 0.5;
    if (std::abs(rows.offset_px) < least_offset_px) return std::nullopt;
    StereoCalibration corrected = calibration;
    const double offset_px = rows.offset_px * corrected.right.fy_px / corrected.rectified.f_px;
    corrected.right.cy_px += offset_px;
    compute_rectification_to(corrected, alpha, farthest_m(calibration.rectified));
    const RowAgreement after = check_rows(corrected, raw_left, raw_right);
    if (after.median_px > most_left_over * rows.median_px) return std::nullopt;
    calibration = corrected;
    rows = after;
    return offset_px;
}

}  // namespace vantage
