#include "common/calibration_forms/calibration_form.h"

#include <algorithm>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"

namespace vantage {
namespace {

constexpr std::size_t max_form_bytes = std::size_t{1} << 26;

}  // namespace

FormFile form_file_of(const std::filesystem::path& path, std::string text) {
    FormFile file{path, std::move(text), nullptr};
    try {
        file.tree = parse_text_tree(file.text, path);
    } catch (const Error&) {
        // COLMAP's files are lines of words; whoever expects a structure finds none.
    }
    return file;
}

FormFile load_form_file(const std::filesystem::path& path) {
    const std::vector<std::byte> bytes = read_file(path, max_form_bytes);
    std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.find('\0') != std::string::npos)
        fail("{} is no text file{}", path.string(),
             path.extension() == ".bin" ? ": of a binary model of COLMAP, colmap model_converter "
                                          "--output_type TXT makes text"
                                        : "");
    return form_file_of(path, std::move(text));
}

std::optional<CalibrationForm> form_of_file(const FormFile& file) {
    for (const CalibrationForm& form : calibration_forms())
        if (form.recognises(file)) return form;
    return std::nullopt;
}

std::string foreign_calibration_sentence(const std::filesystem::path& path,
                                         const std::string& text) {
    const std::optional<CalibrationForm> form = form_of_file(form_file_of(path, text));
    if (!form) return {};
    return fmt::format(
        "this is a calibration of {}, not of Vantage; bring it in with: vantage-calib import {} -o "
        "CALIB.yaml",
        form->program, path.string());
}

}  // namespace vantage
