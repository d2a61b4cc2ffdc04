#include <cstdint>
#include <string>

#include "common/base/error.h"
#include "common/calibration_forms/calibration_form.h"

/// The first byte chooses the file's name, by which some forms are known; the rest is its text.
/// What is read is either a valid camera or refused.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    static constexpr const char* names[] = {"a.yaml", "a.toml", "cameras.txt", "images.txt"};
    const vantage::FormFile file = vantage::form_file_of(
        names[data[0] % 4], std::string(reinterpret_cast<const char*>(data + 1), size - 1));
    if (const auto form = vantage::form_of_file(file)) try {
            for (const vantage::FormCamera& camera :
                 form->read(std::span(&file, 1), {.size_px = cv::Size(640, 480)}).cameras)
                camera.model.validate();
        } catch (const vantage::Error&) {
        }
    return 0;
}
