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

/// One map of a YAML file with its name, so that errors can name the place. Throws Error for values
/// that are missing or of another type.
struct YamlSection {
    cv::FileNode node;
    std::string name;

    cv::FileNode get(const char* key) const;
    YamlSection section(const char* key) const;
    std::string text(const char* key) const;
    int integer(const char* key) const;
    double number(const char* key) const;
    /// A standard deviation: a finite number of at least 0.
    double deviation(const char* key) const;
    /// The elements of a matrix, row by row. Not read with OpenCV's operator, which allocates
    /// whatever size a damaged file states before it checks the elements.
    std::vector<double> matrix(const char* key) const;
    Eigen::Matrix3d matrix3(const char* key) const;
    Eigen::Vector3d vector3(const char* key) const;
    Pose pose(const char* key) const;
};

/// The kind and version of a YAML file of Vantage.
struct YamlKind {
    const char* kind;
    const char* in_words;  ///< "a calibration of Vantage"
    int version;           ///< the current one; versions from 1 on can be read
};

inline constexpr std::size_t max_yaml_bytes = 1 << 20;

/// Reads a YAML file as text, and refuses characters on which OpenCV's parser hangs. Throws Error.
std::string read_yaml_text(const std::filesystem::path& path);
/// Throws Error if the file has another kind or an unknown version.
void require_kind(const YamlSection& top, const YamlKind& kind);

/// Throws Error with the file's name. If another program wrote the file, the error names that
/// program and the command that imports it; otherwise it gives `reason`.
[[noreturn]] void refuse_yaml(const std::filesystem::path& path, const std::string& text,
                              const std::string& reason);

/// Parses a file and returns the result of `read` for its top. Throws Error naming the file.
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
        refuse_yaml(path, text,
                    fmt::format("this is not YAML that OpenCV can read ({})", error.err));
    } catch (const Error& error) {
        refuse_yaml(path, text, error.what());
    } catch (const std::exception& error) {
        // OpenCV throws the standard library's exceptions for some badly damaged files.
        refuse_yaml(path, text,
                    fmt::format("this is not YAML that OpenCV can read ({})", error.what()));
    }
}

/// Writes atomically. An earlier file is kept as PATH.last unless `load` throws Error for it.
/// Throws Error if the file cannot be written.
void write_yaml_keeping_last(const std::filesystem::path& path, const std::string& yaml,
                             const std::function<void(const std::filesystem::path&)>& load);

cv::Mat to_yaml_matrix(const Eigen::Matrix3d& m);
cv::Mat to_yaml_matrix(const Eigen::Vector3d& v);
/// A matrix row that shares the vector's memory.
cv::Mat to_yaml_row(const std::vector<double>& values);

}  // namespace vantage
