#include "host_app/view_sets/view_set_writer.h"

#include <cmath>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/files/folder.h"
#include "common/geometry/json_rows.h"
#include "common/image/image_file.h"
#include "common/image/pfm.h"

namespace vantage {

ViewSetWriter::ViewSetWriter(std::filesystem::path folder) : folder_(std::move(folder)) {
    if (std::filesystem::exists(folder_ / "views.json"))
        fail("{} contains a view set already; give a new folder", folder_.string());
    make_folder(folder_);
}

void ViewSetWriter::begin_view(const Camera& camera, const std::filesystem::path& picture) {
    // A view set is read as a whole: what cannot be read is refused before it is copied.
    picture_size_ = read_colour_image(picture).size();
    document_["views"].push_back({{"name", camera.name},
                                  {"image", copy(picture, camera.name)},
                                  {"K", json_rows(camera.K)},
                                  {"world_from_camera", json_rows(camera.world_from_camera)}});
}

void ViewSetWriter::add_disparity(const Disparity& disparity) {
    const std::string extension = disparity.file.extension().string();
    const bool is_pfm = extension == ".pfm" || extension == ".PFM";
    const cv::Size size =
        is_pfm ? read_pfm(disparity.file).size() : read_code_image(disparity.file).size();
    constexpr double most_aspect_error = 0.03;
    const double aspect = size.aspectRatio() / picture_size_.aspectRatio();
    if (std::abs(aspect - 1) > most_aspect_error)
        fail("{} is {}x{} and its picture {}x{}: they are not of one field of view",
             disparity.file.string(), size.width, size.height, picture_size_.width,
             picture_size_.height);
    auto& view = document_["views"].back();
    view["disparity"] = copy(disparity.file, view["name"].get<std::string>() + "-disparity");
    if (disparity.scale) view["scale"] = *disparity.scale;
    if (disparity.unknown) view["unknown"] = *disparity.unknown;
    view["baseline_m"] = disparity.baseline_m;
    view["doffs_px"] = disparity.doffs_px;
    ++with_geometry_;
}

void ViewSetWriter::add_depth(const DepthImage& depth_m) {
    auto& view = document_["views"].back();
    const std::string name = view["name"].get<std::string>() + "-depth.pfm";
    write_pfm(folder_ / name, depth_m);
    view["depth"] = name;
    ++with_geometry_;
}

void ViewSetWriter::finish() {
    const std::string text = document_.dump(1) + "\n";
    write_text_atomically(folder_ / "views.json", text);
}

std::string ViewSetWriter::copy(const std::filesystem::path& file, const std::string& stem) {
    const std::string name = stem + file.extension().string();
    std::error_code error;
    std::filesystem::copy_file(file, folder_ / name,
                               std::filesystem::copy_options::overwrite_existing, error);
    if (error)
        fail("cannot copy {} to {} ({})", file.string(), (folder_ / name).string(),
             error.message());
    return name;
}

}  // namespace vantage
