#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <opencv2/core.hpp>
#include <unistd.h>

#include "common/image/image_file.h"
#include "common/image/pfm.h"
#include "host_app/view_sets/view_set.h"
#include "tests/fuzz/seeds/input_file.h"

namespace {

/// Pictures that a views.json may name: p.png and d.pfm of 4x3.
class ViewFolder {
  public:
    ViewFolder()
        : path_(std::filesystem::temp_directory_path() /
                ("vantage-view-set-fuzz-" + std::to_string(getpid()))) {
        std::filesystem::create_directories(path_);
        vantage::write_colour_image(path_ / "p.png",
                                    vantage::ColourImage(3, 4, cv::Vec4b(1, 2, 3, 255)));
        vantage::write_pfm(path_ / "d.pfm", cv::Mat1f(3, 4, 2.0f));
    }
    ~ViewFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path put(const char* name, const std::uint8_t* data, std::size_t size) const {
        std::ofstream(path_ / name, std::ios::binary)
            .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
        return path_ / name;
    }

  private:
    std::filesystem::path path_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    static const ViewFolder folder;
    folder.put("views.json", data, size);
    expect_result_or_error([&] { load_view_set(folder.path()); });
    expect_result_or_error([&] { load_virtual_view(folder.put("pose.json", data, size)); });
    expect_result_or_error([&] { load_virtual_view(folder.put("pose.toml", data, size)); });
    return 0;
}
