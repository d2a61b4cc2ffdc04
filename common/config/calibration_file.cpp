#include "common/config/calibration_file.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "common/base/atomic_file.h"
#include "common/base/error.h"
#include "common/geometry/opencv_bridge.h"

namespace vantage {
namespace {

constexpr int file_version = 1;
constexpr std::size_t max_file_bytes = 1 << 20;
constexpr const char* file_kind = "vantage stereo calibration";
constexpr const char* file_units =
    "lengths in metres; pictures in pixels, pixel centres at integers, origin top-left; cameras x "
    "right, y down, z forward; rotations as matrices; distortion in OpenCV's order";

const char* lens_name(LensModel lens) { return lens == LensModel::fisheye ? "fisheye" : "pinhole"; }

// Writing ------------------------------------------------------------------------------------

cv::Mat to_mat(const Eigen::Matrix3d& m) { return cv::Mat(to_cv(m)).clone(); }
cv::Mat to_mat(const Eigen::Vector3d& v) { return cv::Mat(to_cv(v)).clone(); }

cv::Mat to_row(const std::vector<double>& values) {
    return cv::Mat(1, static_cast<int>(values.size()), CV_64F, const_cast<double*>(values.data()));
}

void write_camera(cv::FileStorage& file, const char* name, const CameraModel& camera) {
    file << name << "{";
    file << "width_px" << camera.width_px << "height_px" << camera.height_px;
    file << "lens" << lens_name(camera.lens) << "K" << to_mat(camera.K());
    file << "distortion" << to_row(camera.distortion);
    file << "}";
}

void write_sigma(cv::FileStorage& file, const CalibrationSigma& sigma) {
    file << "sigma"
         << "{";
    for (const bool is_left : {true, false}) {
        const CalibrationSigma::Camera& camera = is_left ? sigma.left : sigma.right;
        file << (is_left ? "left" : "right") << "{";
        file << "fx_px" << camera.fx_px << "fy_px" << camera.fy_px << "cx_px" << camera.cx_px
             << "cy_px" << camera.cy_px << "distortion" << to_row(camera.distortion);
        file << "}";
    }
    file << "right_from_left"
         << "{"
         << "rotation_rad" << to_mat(sigma.rotation_rad) << "translation_m"
         << to_mat(sigma.translation_m) << "}";
    file << "}";
}

std::string to_yaml(const StereoCalibration& c, const CalibrationRecord& record) {
    cv::FileStorage file("calibration.yaml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
    file << "kind" << file_kind << "version" << file_version << "units" << file_units;
    file << "date" << record.date << "tool" << record.tool;
    file << "rms_px" << record.rms_px << "row_rms_px" << record.row_rms_px << "views_used"
         << record.views_used;
    file << "alpha" << record.alpha;
    file << "checksum"
         << "fnv1a64:" + c.id;
    write_camera(file, "left", c.left);
    write_camera(file, "right", c.right);
    file << "right_from_left"
         << "{"
         << "rotation" << to_mat(Eigen::Matrix3d(c.right_from_left.linear())) << "translation_m"
         << to_mat(Eigen::Vector3d(c.right_from_left.translation())) << "}";
    const RectifiedStereo& r = c.rectified;
    file << "rectified"
         << "{"
         << "width_px" << r.width_px << "height_px" << r.height_px << "f_px" << r.f_px
         << "cx_left_px" << r.cx_left_px << "cx_right_px" << r.cx_right_px << "cy_px" << r.cy_px
         << "baseline_m" << r.baseline_m << "rectified_from_left" << to_mat(c.rectified_from_left)
         << "rectified_from_right" << to_mat(c.rectified_from_right) << "}";
    file << "world_from_left"
         << "{"
         << "rotation" << to_mat(Eigen::Matrix3d(c.world_from_left.linear())) << "translation_m"
         << to_mat(Eigen::Vector3d(c.world_from_left.translation())) << "}";
    if (record.sigma) write_sigma(file, *record.sigma);
    return file.releaseAndGetString();
}

// Reading ------------------------------------------------------------------------------------

/// One map of the file with its name, so that every fault can say where it is.
struct Section {
    cv::FileNode node;
    std::string name;

    cv::FileNode get(const char* key) const {
        const cv::FileNode value = node[key];
        if (value.empty()) fail("'{}{}' is missing", name, key);
        return value;
    }
    Section section(const char* key) const {
        const cv::FileNode value = get(key);
        if (!value.isMap()) fail("'{}{}' must be a map", name, key);
        return {value, name + key + "."};
    }
    std::string text(const char* key) const {
        const cv::FileNode value = get(key);
        if (!value.isString()) fail("'{}{}' must be a text", name, key);
        return static_cast<std::string>(value);
    }
    int integer(const char* key) const {
        const cv::FileNode value = get(key);
        if (!value.isInt()) fail("'{}{}' must be an integer", name, key);
        return static_cast<int>(value);
    }
    double number(const char* key) const {
        const cv::FileNode value = get(key);
        if (!value.isInt() && !value.isReal()) fail("'{}{}' must be a number", name, key);
        return static_cast<double>(value);
    }
    /// Elements of a matrix, row by row. Read here and not with OpenCV's operator, which allocates
    /// whatever size a damaged file states before it looks at the elements.
    std::vector<double> matrix(const char* key) const {
        const Section header = section(key);
        const cv::FileNode data = header.get("data");
        const int rows = header.integer("rows"), cols = header.integer("cols");
        if (rows < 0 || cols < 0 ||
            static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols) != data.size())
            fail("'{}{}' is {}x{} and holds {} numbers", name, key, rows, cols, data.size());
        std::vector<double> values;
        for (const cv::FileNode& element : data) {
            if (!element.isInt() && !element.isReal())
                fail("'{}{}' holds something that is not a number", name, key);
            values.push_back(static_cast<double>(element));
        }
        return values;
    }
    Eigen::Matrix3d matrix3(const char* key) const {
        const std::vector<double> values = matrix(key);
        if (values.size() != 9) fail("'{}{}' must be a 3x3 matrix", name, key);
        return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.data());
    }
    Eigen::Vector3d vector3(const char* key) const {
        const std::vector<double> values = matrix(key);
        if (values.size() != 3) fail("'{}{}' must have 3 numbers", name, key);
        return {values[0], values[1], values[2]};
    }
    Pose pose(const char* key) const {
        const Section parts = section(key);
        Pose result = Pose::Identity();
        result.linear() = parts.matrix3("rotation");
        result.translation() = parts.vector3("translation_m");
        return result;
    }
};

CameraModel read_camera(const Section& s) {
    CameraModel camera;
    camera.width_px = s.integer("width_px");
    camera.height_px = s.integer("height_px");
    const std::string lens = s.text("lens");
    if (lens != "pinhole" && lens != "fisheye")
        fail("'{}lens' is '{}', and it must be pinhole or fisheye", s.name, lens);
    camera.lens = lens == "fisheye" ? LensModel::fisheye : LensModel::pinhole;
    const Eigen::Matrix3d K = s.matrix3("K");
    if (K(1, 0) != 0 || K(2, 0) != 0 || K(2, 1) != 0 || K(2, 2) != 1)
        fail("'{}K' must be [f_x, skew, c_x; 0, f_y, c_y; 0, 0, 1]", s.name);
    camera.fx_px = K(0, 0);
    camera.fy_px = K(1, 1);
    camera.cx_px = K(0, 2);
    camera.cy_px = K(1, 2);
    camera.skew_px = K(0, 1);
    camera.distortion = s.matrix("distortion");
    return camera;
}

StereoCalibration read_calibration(const Section& top) {
    StereoCalibration c;
    c.left = read_camera(top.section("left"));
    c.right = read_camera(top.section("right"));
    c.right_from_left = top.pose("right_from_left");
    const Section r = top.section("rectified");
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
    c.id = calibration_checksum(c);
    if (top.text("checksum") != "fnv1a64:" + c.id)
        fail(
            "the checksum does not fit the numbers (fnv1a64:{} would): the file was changed or is "
            "damaged; calibrate again or take the last good file",
            c.id);
    return c;
}

double deviation(const Section& s, const char* key) {
    const double value = s.number(key);
    if (!(value >= 0 && std::isfinite(value)))
        fail("'{}{}' is {}, and a deviation is 0 or more", s.name, key, value);
    return value;
}

CalibrationSigma read_sigma(const Section& s, const StereoCalibration& calibration) {
    CalibrationSigma sigma;
    for (const bool is_left : {true, false}) {
        CalibrationSigma::Camera& camera = is_left ? sigma.left : sigma.right;
        const Section part = s.section(is_left ? "left" : "right");
        camera.fx_px = deviation(part, "fx_px");
        camera.fy_px = deviation(part, "fy_px");
        camera.cx_px = deviation(part, "cx_px");
        camera.cy_px = deviation(part, "cy_px");
        camera.distortion = part.matrix("distortion");
        const std::size_t wanted =
            (is_left ? calibration.left : calibration.right).distortion.size();
        if (camera.distortion.size() != wanted)
            fail("'{}distortion' has {} numbers for {} coefficients", part.name,
                 camera.distortion.size(), wanted);
    }
    const Section pose = s.section("right_from_left");
    sigma.rotation_rad = pose.vector3("rotation_rad");
    sigma.translation_m = pose.vector3("translation_m");
    return sigma;
}

CalibrationRecord read_record(const Section& top, const StereoCalibration& calibration) {
    CalibrationRecord record = {.date = top.text("date"),
                                .tool = top.text("tool"),
                                .rms_px = top.number("rms_px"),
                                .row_rms_px = top.number("row_rms_px"),
                                .views_used = top.integer("views_used")};
    // Files of the first version had neither.
    if (!top.node["alpha"].empty()) record.alpha = top.number("alpha");
    if (!top.node["sigma"].empty()) record.sigma = read_sigma(top.section("sigma"), calibration);
    return record;
}

/// OpenCV's parser goes round for ever on some control characters.
void require_text(const std::filesystem::path& path, const std::string& text) {
    const auto is_control = [](char c) {
        return static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\r' && c != '\t';
    };
    const auto at = std::find_if(text.begin(), text.end(), is_control);
    if (at != text.end())
        fail("{}: byte {} is a control character; a calibration is a text file", path.string(),
             at - text.begin());
}

template <class Read>
auto read_yaml(const std::filesystem::path& path, Read read) {
    const std::vector<std::byte> bytes = read_file(path, max_file_bytes);
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    require_text(path, text);
    try {
        const cv::FileStorage file(
            text, cv::FileStorage::READ | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_YAML);
        const Section top{file.root(), ""};
        if (!file.isOpened() || !top.node.isMap() || top.text("kind") != file_kind)
            fail("this is not a calibration of Vantage");
        const int version = top.integer("version");
        if (version != file_version)
            fail("it is of version {}, and this program reads version {}", version, file_version);
        return read(top);
    } catch (const cv::Exception& error) {
        fail("{}: this is not YAML that OpenCV reads ({})", path.string(), error.err);
    } catch (const Error& error) {
        fail("{}: {}", path.string(), error.what());
    } catch (const std::exception& error) {
        // OpenCV lets the standard library's own exceptions out where a file is badly damaged.
        fail("{}: this is not YAML that OpenCV reads ({})", path.string(), error.what());
    }
}

bool is_good(const std::filesystem::path& path) {
    try {
        load_calibration(path);
        return true;
    } catch (const Error&) {
        return false;
    }
}

// The checksum -------------------------------------------------------------------------------

class Fnv1a64 {
  public:
    void add(std::string_view text) {
        for (const char c : text) {
            hash_ ^= static_cast<unsigned char>(c);
            hash_ *= 0x100000001b3ull;
        }
    }
    /// In the shortest decimal form that reads back as the same number; -0 counts as 0.
    void add(double number) { add(fmt::format("{};", number == 0 ? 0.0 : number)); }
    template <class Derived>
    void add_rows(const Eigen::MatrixBase<Derived>& m) {
        for (Eigen::Index r = 0; r < m.rows(); ++r)
            for (Eigen::Index c = 0; c < m.cols(); ++c) add(m(r, c));
    }
    void add(const Pose& pose) {
        add_rows(pose.linear());
        add_rows(pose.translation());
    }
    void add(const CameraModel& camera) {
        add(camera.width_px);
        add(camera.height_px);
        add(lens_name(camera.lens));
        add_rows(camera.K());
        add(static_cast<double>(camera.distortion.size()));
        for (const double k : camera.distortion) add(k);
    }
    std::string hex() const { return fmt::format("{:016x}", hash_); }

  private:
    std::uint64_t hash_ = 0xcbf29ce484222325ull;
};

}  // namespace

std::string calibration_checksum(const StereoCalibration& c) {
    Fnv1a64 hash;
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
    return hash.hex();
}

StereoCalibration load_calibration(const std::filesystem::path& path) {
    return read_yaml(path, read_calibration);
}

CalibrationRecord load_calibration_record(const std::filesystem::path& path) {
    return read_yaml(path,
                     [](const Section& top) { return read_record(top, read_calibration(top)); });
}

void save_calibration(const std::filesystem::path& path, StereoCalibration calibration,
                      const CalibrationRecord& record) {
    calibration.validate();
    calibration.id = calibration_checksum(calibration);
    const std::string yaml = to_yaml(calibration, record);
    if (std::filesystem::exists(path) && is_good(path))
        write_file_atomically(path.string() + ".last", read_file(path, max_file_bytes));
    write_file_atomically(path, std::as_bytes(std::span(yaml)));
}

}  // namespace vantage
