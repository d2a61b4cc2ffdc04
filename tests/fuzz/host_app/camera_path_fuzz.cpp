#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "host_app/camera_paths/camera_path.h"
#include "tests/fuzz/seeds/input_file.h"

/// The first byte says which form the others are in.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    if (size == 0) return 0;
    const std::span bytes = std::as_bytes(std::span(data + 1, size - 1));
    const std::string text(reinterpret_cast<const char*>(data + 1), size - 1);
    const std::filesystem::path file = "/nowhere/path";
    expect_result_or_error([&] {
        switch (data[0] % 4) {
            case 0:
                (void)freed_path_of(bytes, file, {});
                break;
            case 1: {
                // Both files of a model, one after the other.
                const std::size_t end = text.find("\n--\n");
                const std::string cameras = end == std::string::npos ? "" : text.substr(end + 4);
                (void)colmap_path_of(text.substr(0, end), cameras, file, {});
                break;
            }
            case 2:
                (void)omaf_path_of(text, file, {});
                break;
            default:
                (void)gltf_path_of(bytes, file, {});
        }
    });
    return 0;
}
