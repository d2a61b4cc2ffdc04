#include "host_app/view_sets/view_set_writer.h"

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/files/folder.h"
#include "common/image/pfm.h"

namespace vantage {
namespace {

template <typename Matrix>
nlohmann::ordered_json rows_of(const Matrix& matrix) {
    auto rows = nlohmann::ordered_json::array();
    for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
        auto row = nlohmann::ordered_json::array();
        for (Eigen::Index c = 0; c < matrix.cols(); ++c) row.push_back(matrix(r, c));
        rows.push_back(row);
    }
    return rows;
}

}  // namespace

ViewSetWriter::ViewSetWriter(std::filesystem::path folder) : folder_(std::move(folder)) {
    if (std::filesystem::exists(folder_ / "views.json"))
        fail("{} contains a view set already; give a new folder", folder_.string());
    make_folder(folder_);
}

void ViewSetWriter::begin_view(const Camera& camera, const std::filesystem::path& picture) {
    const Eigen::Matrix<double, 3, 4> pose = camera.world_from_camera.matrix().topRows<3>();
    document_["views"].push_back({{"name", camera.name},
                                  {"image", copy(picture, camera.name)},
                                  {"K", rows_of(camera.K)},
                                  {"world_from_camera", rows_of(pose)}});
}

void ViewSetWriter::add_disparity(const Disparity& disparity) {
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
