#include "host_app/view_sets/view_set.h"

#include <cmath>
#include <set>
#include <sstream>

#include <Eigen/SVD>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <toml++/toml.h>

#include "common/av/video_reader.h"
#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/files/folder.h"
#include "common/base/log.h"
#include "common/config/stage_cameras.h"
#include "common/geometry/json_rows.h"
#include "common/gl/context/limits.h"
#include "common/image/image_file.h"
#include "common/image/pfm.h"

namespace vantage {
namespace {

using nlohmann::json;

constexpr std::size_t max_json_bytes = std::size_t{16} << 20;
constexpr std::size_t max_views = 256;
constexpr double max_rotation_error = 1e-3;

/// A JSON object and its place for error messages.
struct Entry {
    const json& object;
    std::string where;  ///< "FILE, view 'NAME'"

    bool has(const char* key) const { return object.contains(key) && !object[key].is_null(); }

    const json& at(const char* key) const {
        if (!has(key)) fail("{}: the key '{}' is missing; add it", where, key);
        return object[key];
    }

    std::string text(const char* key) const {
        const json& value = at(key);
        if (!value.is_string() || value.get_ref<const std::string&>().empty())
            fail("{}: '{}' must be a text that is not empty", where, key);
        return value.get<std::string>();
    }

    double number(const char* key) const { return number(at(key), key); }
    double number(const char* key, double otherwise) const {
        return has(key) ? number(key) : otherwise;
    }
    double number(const json& value, const char* key) const {
        if (!value.is_number() || !std::isfinite(value.get<double>()))
            fail("{}: '{}' must be a finite number", where, key);
        return value.get<double>();
    }

    int pixels(const char* key) const {
        const json& value = at(key);
        const double side = value.is_number_integer() ? value.get<double>() : 0;
        if (side < 1 || side > PiLimits::max_image_side_px)
            fail("{}: '{}' must be a whole number of pixels from 1 to {}", where, key,
                 PiLimits::max_image_side_px);
        return static_cast<int>(side);
    }

    template <int Rows, int Columns>
    Eigen::Matrix<double, Rows, Columns> matrix(const char* key) const {
        const json& rows = at(key);
        Eigen::Matrix<double, Rows, Columns> m;
        bool fits = rows.is_array() && rows.size() == static_cast<std::size_t>(Rows);
        for (int r = 0; fits && r < Rows; ++r) {
            const json& row = rows[static_cast<std::size_t>(r)];
            fits = row.is_array() && row.size() == static_cast<std::size_t>(Columns);
            for (int c = 0; fits && c < Columns; ++c)
                m(r, c) = number(row[static_cast<std::size_t>(c)], key);
        }
        if (!fits) fail("{}: '{}' must be {} rows of {} numbers each", where, key, Rows, Columns);
        return m;
    }

    Eigen::Matrix3d intrinsics() const {
        const Eigen::Matrix3d K = matrix<3, 3>("K");
        if (K(0, 0) <= 0 || K(1, 1) <= 0 || K(1, 0) != 0 || K(2, 0) != 0 || K(2, 1) != 0 ||
            K(2, 2) != 1)
            fail("{}: 'K' must be [[fx, skew, cx], [0, fy, cy], [0, 0, 1]] with fx and fy above 0",
                 where);
        return K;
    }

    Pose pose() const {
        const auto m = matrix<3, 4>("world_from_camera");
        const Eigen::Matrix3d rotation = m.leftCols<3>();
        const double error =
            (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
        if (error > max_rotation_error || rotation.determinant() < 0)
            fail(
                "{}: 'world_from_camera' is not rigid (its left 3x3 part must be a rotation; it "
                "departs from one by {:.3g}); give [R | t] without scale or mirroring",
                where, rotation.determinant() < 0 ? 2.0 : error);
        const Eigen::JacobiSVD<Eigen::Matrix3d> svd(rotation,
                                                    Eigen::ComputeFullU | Eigen::ComputeFullV);
        Pose pose = Pose::Identity();
        pose.linear() = svd.matrixU() * svd.matrixV().transpose();
        pose.translation() = m.col(3);
        return pose;
    }

    void warn_of_unknown_keys(const std::set<std::string>& known) const {
        for (const auto& [key, value] : object.items())
            if (!known.contains(key))
                log_warning("{}: the key '{}' is unknown and ignored", where, key);
    }
};

json parse_json(const std::filesystem::path& path) {
    json document;
    try {
        document = json::parse(read_text_file(path, max_json_bytes));
    } catch (const json::parse_error& error) {
        fail("{} is not JSON (near byte {}); correct it there", path.string(), error.byte);
    } catch (const json::out_of_range&) {
        fail("{} has a number beyond the range of a double", path.string());
    }
    if (!document.is_object()) fail("{} must hold one JSON object", path.string());
    return document;
}

json parse_toml(const std::filesystem::path& path) {
    try {
        const toml::table table = toml::parse(read_text_file(path, max_json_bytes), path.string());
        std::ostringstream text;
        text << toml::json_formatter(table);
        return json::parse(text.str());
    } catch (const toml::parse_error& error) {
        fail("{} is not TOML (line {}): {}", path.string(), error.source().begin.line,
             error.description());
    } catch (const json::exception&) {
        fail("{} has a number that is not finite", path.string());
    }
}

/// File values as float; unknown ones (0, not finite, or equal to `unknown`, depending on the file)
/// become NaN.
cv::Mat1f read_map(const std::filesystem::path& path, const Entry& entry, bool is_pfm) {
    const float nothing = std::numeric_limits<float>::quiet_NaN();
    cv::Mat1f map;
    if (is_pfm)
        map = read_pfm(path);
    else
        read_code_image(path).convertTo(map, CV_32F);
    const bool has_unknown = entry.has("unknown");
    const auto unknown = static_cast<float>(entry.number("unknown", 0));
    for (float& value : map)
        if (!std::isfinite(value) || (has_unknown && value == unknown)) value = nothing;
    return map;
}

DepthImage read_depth(const Entry& entry, const std::filesystem::path& folder,
                      const DepthView& view) {
    const bool is_disparity = entry.has("disparity");
    const char* key = is_disparity ? "disparity" : "depth";
    const std::filesystem::path path = folder / entry.text(key);
    const bool is_pfm = path.extension() == ".pfm" || path.extension() == ".PFM";
    const double scale = is_pfm ? entry.number("scale", 1) : entry.number("scale");
    if (scale <= 0) fail("{}: 'scale' is {}, but must be above 0", entry.where, scale);
    cv::Mat1f map = read_map(path, entry, is_pfm);
    if (map.cols > PiLimits::max_image_side_px || map.rows > PiLimits::max_image_side_px)
        fail("{}: {} is {}x{}; the largest side of a map is {} pixels", entry.where, path.string(),
             map.cols, map.rows, PiLimits::max_image_side_px);
    const double aspect = static_cast<double>(map.cols) / map.rows * view.colour.rows /
                          static_cast<double>(view.colour.cols);
    if (aspect < 0.97 || aspect > 1.03)
        fail(
            "{}: {} is {}x{} and the image {}x{}; give a map of the image's size or with the same "
            "field of view",
            entry.where, path.string(), map.cols, map.rows, view.colour.cols, view.colour.rows);
    const double f_baseline = view.K(0, 0) * view.baseline_m;
    DepthImage depth_m(map.size());
    for (int y = 0; y < map.rows; ++y)
        for (int x = 0; x < map.cols; ++x) {
            const double value = static_cast<double>(map(y, x)) * scale;
            const double z = is_disparity ? f_baseline / (value + view.doffs_px) : value;
            depth_m(y, x) = std::isfinite(z) && z > 0 ? static_cast<float>(z) : 0.0f;
        }
    return depth_m;
}

DepthView read_view(const Entry& entry, const std::filesystem::path& folder) {
    DepthView view;
    view.name = entry.text("name");
    view.K = entry.intrinsics();
    view.world_from_camera = entry.pose();
    entry.warn_of_unknown_keys({"name", "image", "outline", "disparity", "depth", "scale",
                                "unknown", "K", "world_from_camera", "baseline_m", "doffs_px"});
    if (entry.has("disparity") && entry.has("depth"))
        fail("{}: both 'disparity' and 'depth' are given; keep one", entry.where);
    view.doffs_px = entry.number("doffs_px", 0);
    view.baseline_m = entry.number("baseline_m", 0);
    if (entry.has("disparity") && entry.number("baseline_m") <= 0)
        fail("{}: 'baseline_m' is {}, but with 'disparity' it must be above 0", entry.where,
             view.baseline_m);
    try {
        const std::filesystem::path picture = folder / entry.text("image");
        view.colour = read_colour_image(picture);
        if (view.colour.cols > PiLimits::max_image_side_px ||
            view.colour.rows > PiLimits::max_image_side_px)
            fail("{} is {}x{}; the largest side of an image is {} pixels", picture.string(),
                 view.colour.cols, view.colour.rows, PiLimits::max_image_side_px);
        if (entry.has("disparity") || entry.has("depth"))
            view.depth_m = read_depth(entry, folder, view);
    } catch (const Error& error) {
        const std::string reason = error.what();
        if (reason.starts_with(entry.where)) throw;
        fail("{}: {}", entry.where, reason);
    }
    return view;
}

/// Where each pixel of an ideal camera with the same matrix is in the picture of the lens.
void undistortion_of(const CameraModel& camera, cv::Mat1f& x_map, cv::Mat1f& y_map) {
    x_map.create(camera.height_px, camera.width_px);
    y_map.create(camera.height_px, camera.width_px);
    const Eigen::Matrix3d ray_from_pixel = camera.K().inverse();
    for (int y = 0; y < camera.height_px; ++y)
        for (int x = 0; x < camera.width_px; ++x) {
            const auto place = camera.project(ray_from_pixel * Eigen::Vector3d(x, y, 1));
            x_map(y, x) = place ? static_cast<float>(place->x()) : -1.0f;
            y_map(y, x) = place ? static_cast<float>(place->y()) : -1.0f;
        }
}

ColourImage picture_of(const SingleCamera& camera) {
    if (camera.source.empty())
        fail("the camera '{}' has no 'source': name its picture or its video", camera.name);
    ColourImage picture;
    if (is_picture_file(camera.source)) {
        picture = read_colour_image(camera.source);
    } else {
        const auto first = VideoReader(camera.source).next();
        if (!first) fail("{} holds no picture", camera.source);
        picture = *first;
    }
    if (picture.cols != camera.model.width_px || picture.rows != camera.model.height_px)
        fail("{} is {}x{}, and the calibration of the camera '{}' is for {}x{}", camera.source,
             picture.cols, picture.rows, camera.name, camera.model.width_px,
             camera.model.height_px);
    return picture;
}

}  // namespace

std::size_t ViewSet::index_of(std::string_view name) const {
    std::string known;
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (views[i].name == name) return i;
        known += (known.empty() ? "" : ", ") + views[i].name;
    }
    fail("the view set has no view named '{}'; it has: {}", name, known);
}

ViewSet load_view_set(const std::filesystem::path& folder) {
    const std::filesystem::path path = folder / "views.json";
    const json document = parse_json(path);
    const Entry top{document, path.string()};
    const json& version = top.at("version");
    if (!version.is_number_integer() || version.get<std::int64_t>() != 1)
        fail("{}: 'version' is {}, but this program reads version 1", path.string(),
             version.dump());
    top.warn_of_unknown_keys({"version", "views"});
    const json& entries = top.at("views");
    if (!entries.is_array() || entries.empty() || entries.size() > max_views)
        fail("{}: 'views' must be a list of 1 to {} views", path.string(), max_views);
    ViewSet set;
    std::set<std::string> names;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        Entry entry{entries[i], fmt::format("{}, view {}", path.string(), i + 1)};
        if (!entry.object.is_object()) fail("{} must be an object", entry.where);
        entry.where = fmt::format("{}, view '{}'", path.string(), entry.text("name"));
        if (!names.insert(entry.text("name")).second)
            fail("{}: another view has this name; give each its own", entry.where);
        set.views.push_back(read_view(entry, folder));
        set.outlines.push_back(entry.has("outline") ? read_outline(folder / entry.text("outline"),
                                                                   set.views.back().name,
                                                                   set.views.back().colour.size())
                                                    : GreyImage());
    }
    return set;
}

GreyImage read_outline(const std::filesystem::path& file, const std::string& view, cv::Size size) {
    const GreyImage outline = to_grey(read_colour_image(file));
    if (outline.size() != size)
        fail("{} is {}x{}, and the picture of the view '{}' is {}x{}: give an outline of its size",
             file.string(), outline.cols, outline.rows, view, size.width, size.height);
    return outline;
}

VirtualView load_virtual_view(const std::filesystem::path& file) {
    const json document = file.extension() == ".toml" ? parse_toml(file) : parse_json(file);
    const Entry entry{document, file.string()};
    VirtualView view;
    view.width_px = entry.pixels("width");
    view.height_px = entry.pixels("height");
    view.K = entry.intrinsics();
    view.world_from_camera = entry.pose();
    entry.warn_of_unknown_keys({"width", "height", "K", "world_from_camera"});
    return view;
}

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

ViewSet load_stage_views(const std::filesystem::path& stage) {
    ViewSet set;
    for (const SingleCamera& camera : load_stage_cameras(stage)) {
        cv::Mat1f x_map, y_map;
        undistortion_of(camera.model, x_map, y_map);
        DepthView view;
        view.name = camera.name;
        view.K = camera.model.K();
        view.world_from_camera = camera.world_from_camera;
        cv::remap(picture_of(camera), view.colour, x_map, y_map, cv::INTER_LINEAR);
        GreyImage outline;
        if (!camera.outline.empty()) {
            const GreyImage drawn = read_outline(camera.outline, camera.name, x_map.size());
            cv::remap(drawn, outline, x_map, y_map, cv::INTER_LINEAR);
        }
        set.views.push_back(std::move(view));
        set.outlines.push_back(std::move(outline));
    }
    return set;
}

}  // namespace vantage
