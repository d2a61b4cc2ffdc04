#include "common/config/yaml/yaml_section.h"

#include <algorithm>
#include <cmath>

#include "common/base/files/atomic_file.h"
#include "common/calibration_forms/calibration_form.h"
#include "common/geometry/opencv_bridge.h"

namespace vantage {

cv::FileNode YamlSection::get(const char* key) const {
    const cv::FileNode value = node[key];
    if (value.empty()) fail("'{}{}' is missing", name, key);
    return value;
}
YamlSection YamlSection::section(const char* key) const {
    const cv::FileNode value = get(key);
    if (!value.isMap()) fail("'{}{}' must be a map", name, key);
    return {value, name + key + "."};
}
std::string YamlSection::text(const char* key) const {
    const cv::FileNode value = get(key);
    if (!value.isString()) fail("'{}{}' must be a text", name, key);
    return static_cast<std::string>(value);
}
int YamlSection::integer(const char* key) const {
    const cv::FileNode value = get(key);
    if (!value.isInt()) fail("'{}{}' must be an integer", name, key);
    return static_cast<int>(value);
}
double YamlSection::number(const char* key) const {
    const cv::FileNode value = get(key);
    if (!value.isInt() && !value.isReal()) fail("'{}{}' must be a number", name, key);
    return static_cast<double>(value);
}
std::vector<double> YamlSection::matrix(const char* key) const {
    const YamlSection header = section(key);
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
Eigen::Matrix3d YamlSection::matrix3(const char* key) const {
    const std::vector<double> values = matrix(key);
    if (values.size() != 9) fail("'{}{}' must be a 3x3 matrix", name, key);
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.data());
}
Eigen::Vector3d YamlSection::vector3(const char* key) const {
    const std::vector<double> values = matrix(key);
    if (values.size() != 3) fail("'{}{}' must have 3 numbers", name, key);
    return {values[0], values[1], values[2]};
}
Pose YamlSection::pose(const char* key) const {
    const YamlSection parts = section(key);
    Pose result = Pose::Identity();
    result.linear() = parts.matrix3("rotation");
    result.translation() = parts.vector3("translation_m");
    return result;
}
double YamlSection::deviation(const char* key) const {
    const double value = number(key);
    if (!(value >= 0 && std::isfinite(value)))
        fail("'{}{}' is {}, but a deviation is 0 or more", name, key, value);
    return value;
}

std::string read_yaml_text(const std::filesystem::path& path) {
    const std::vector<std::byte> bytes = read_file(path, max_yaml_bytes);
    std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    // OpenCV's parser loops for ever on some control characters.
    const auto is_control = [](char c) {
        return static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\r' && c != '\t';
    };
    const auto at = std::find_if(text.begin(), text.end(), is_control);
    if (at != text.end())
        fail("{}: byte {} is a control character; a calibration is a text file", path.string(),
             at - text.begin());
    return text;
}

void refuse_yaml(const std::filesystem::path& path, const std::string& text,
                 const std::string& reason) {
    // A damaged file of Vantage's own says what is damaged.
    const bool is_own = text.find("\"vantage ") != std::string::npos;
    const std::string foreign = is_own ? "" : foreign_calibration_sentence(path, text);
    fail("{}: {}", path.string(), foreign.empty() ? reason : foreign);
}

void require_kind(const YamlSection& top, const YamlKind& kind) {
    if (top.text("kind") != kind.kind) fail("this is not {}", kind.in_words);
    const int version = top.integer("version");
    if (version < 1 || version > kind.version)
        fail("it has version {}, but this program reads versions 1 to {}", version, kind.version);
}

void write_yaml_keeping_last(const std::filesystem::path& path, const std::string& yaml,
                             const std::function<void(const std::filesystem::path&)>& load) {
    const auto is_good = [&] {
        try {
            load(path);
            return true;
        } catch (const Error&) {
            return false;
        }
    };
    if (std::filesystem::exists(path) && is_good())
        write_file_atomically(path.string() + ".last", read_file(path, max_yaml_bytes));
    write_text_atomically(path, yaml);
}

cv::Mat to_yaml_matrix(const Eigen::Matrix3d& m) { return cv::Mat(to_cv(m)).clone(); }
cv::Mat to_yaml_matrix(const Eigen::Vector3d& v) { return cv::Mat(to_cv(v)).clone(); }

cv::Mat to_yaml_row(const std::vector<double>& values) {
    return cv::Mat(1, static_cast<int>(values.size()), CV_64F, const_cast<double*>(values.data()));
}

}  // namespace vantage
