#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "common/base/error.h"
#include "common/geometry/pose.h"

namespace vantage {

/// One map of a YAML file with its name, so that every fault can say where it is. Throws Error for
/// what is missing or of another kind.
struct YamlSection {
    cv::FileNode node;
    std::string name;

    cv::FileNode get(const char* key) const;
    YamlSection section(const char* key) const;
    std::string text(const char* key) const;
    int integer(const char* key) const;
    double number(const char* key) const;
    /// A standard deviation: a finite number, 0 or more.
    double deviation(const char* key) const;
    /// Elements of a matrix, row by row. Read here and not with OpenCV's operator, which allocates
    /// whatever size a damaged file states before it looks at the elements.
    std::vector<double> matrix(const char* key) const;
    Eigen::Matrix3d matrix3(const char* key) const;
    Eigen::Vector3d vector3(const char* key) const;
    Pose pose(const char* key) const;
};

/// What a YAML file of Vantage says of itself.
struct YamlKind {
    const char* kind;
    const char* in_words;  ///< "a calibration of Vantage"
    int version;           ///< that is written; older ones from 1 on are read
};

inline constexpr std::size_t max_yaml_bytes = 1 << 20;

/// The text of a YAML file, without what OpenCV's parser would never end on. Throws Error.
std::string read_yaml_text(const std::filesystem::path& path);
/// Throws Error if the file is of another kind, or of a version that is not read.
void require_kind(const YamlSection& top, const YamlKind& kind);

/// Throws Error, naming the file: whose calibration it is where another program wrote it, else
/// `reason`.
[[noreturn]] void refuse_yaml(const std::filesystem::path& path, const std::string& text,
                              const std::string& reason);

/// What `read` makes of the file's top. Throws Error, naming the file, for whatever is wrong.
template <class Read>
auto read_yaml(const std::filesystem::path& path, const YamlKind& kind, Read read) {
    const std::string text = read_yaml_text(path);
    try {
        const cv::FileStorage file(
            text, cv::FileStorage::READ | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_YAML);
        const YamlSection top{file.root(), ""};
        if (!file.isOpened() || !top.node.isMap()) fail("this is not {}", kind.in_words);
        require_kind(top, kind);
        return read(top);
    } catch (const cv::Exception& error) {
        refuse_yaml(path, text, fmt::format("this is not YAML that OpenCV reads ({})", error.err));
    } catch (const Error& error) {
        refuse_yaml(path, text, error.what());
    } catch (const std::exception& error) {
        // OpenCV lets the standard library's own exceptions out where a file is badly damaged.
        refuse_yaml(path, text,
                    fmt::format("this is not YAML that OpenCV reads ({})", error.what()));
    }
}

/// Writes atomically. A file that stood there before is kept as PATH.last unless `load` throws
/// Error for it. Throws Error if the disk refuses.
void write_yaml_keeping_last(const std::filesystem::path& path, const std::string& yaml,
                             const std::function<void(const std::filesystem::path&)>& load);

cv::Mat to_yaml_matrix(const Eigen::Matrix3d& m);
cv::Mat to_yaml_matrix(const Eigen::Vector3d& v);
/// A row, over the vector's own memory.
cv::Mat to_yaml_row(const std::vector<double>& values);

}  // namespace vantage
