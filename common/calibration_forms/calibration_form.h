#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

#include "common/calibration_forms/text_tree.h"
#include "common/geometry/stereo_calibration.h"

namespace vantage {

/// A text file of another program.
struct FormFile {
    std::filesystem::path path;
    std::string text;
    Tree tree;  ///< null where the text is neither JSON, XML, TOML nor YAML

    std::string name() const { return path.filename().string(); }
};
/// Reads and parses the file; a text that has no structure has no tree. Throws Error if it cannot
/// be read, or is no text.
FormFile load_form_file(const std::filesystem::path& path);
FormFile form_file_of(const std::filesystem::path& path, std::string text);

/// A camera in Vantage's conventions (see CameraModel), whatever the file's were.
struct FormCamera {
    std::string name;
    CameraModel model;
    /// In a frame that all cameras of the calibration share, in the file's unit of length; empty
    /// where the file states none.
    std::optional<Pose> camera_from_frame = {};
};

/// A calibration as the reader of a form returns it, with sentences for people about it.
struct FormCalibration {
    std::vector<FormCamera> cameras;
    double metres_per_unit = 1;   ///< by the form's definition
    bool unit_is_assumed = true;  ///< the form defines none
    std::vector<std::string> left_out, assumed;
};

/// Settings that a file may lack, so that the user gives them.
struct FormSettings {
    std::optional<cv::Size> size_px = {};
    bool is_fisheye = false;  ///< where a file has four coefficients and does not state their model
};

struct FormText {
    std::string name;  ///< of the file, in a folder of its own where there are several
    std::string text;
};

/// One program's way to write calibrations. A file forms/NAME_form.cpp defines
/// `CalibrationForm NAME_form_entry()`.
struct CalibrationForm {
    std::string name;     ///< for --as and --from: "kalibr"
    std::string program;  ///< for people: "Kalibr (camchain)"
    bool (*recognises)(const FormFile& file);
    /// Throws Error naming the file and the value for what is missing, damaged or not known.
    FormCalibration (*read)(std::span<const FormFile> files, const FormSettings& settings);
    /// Throws Error for a lens that the form cannot express. Null: it is only read.
    std::vector<FormText> (*write)(const StereoCalibration& calibration) = nullptr;
};
std::vector<CalibrationForm> calibration_forms();

/// The form of the file; nothing: none that is known.
std::optional<CalibrationForm> form_of_file(const FormFile& file);

/// The sentence for a reader of Vantage's own files that was given this text: which program's
/// calibration it is, and the command that brings it in. Empty where it is none that is known.
std::string foreign_calibration_sentence(const std::filesystem::path& path,
                                         const std::string& text);

}  // namespace vantage
