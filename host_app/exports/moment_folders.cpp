#include <cmath>
#include <limits>
#include <string>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/files/atomic_file.h"
#include "common/base/files/folder.h"
#include "common/image/image_file.h"
#include "host_app/exports/moment.h"
#include "host_app/view_sets/view_set.h"

namespace vantage {
namespace {

/// Writes the image beside `stem`: the received JPEG if there is one, otherwise a PNG.
std::filesystem::path write_picture(const MomentView& view, std::filesystem::path stem) {
    stem += view.jpeg.empty() ? ".png" : ".jpg";
    if (view.jpeg.empty())
        write_colour_image(stem, view.colour);
    else
        write_file_atomically(stem, view.jpeg);
    return stem;
}

/// Depth in millimetres at the size of the colour image.
cv::Mat1w depth_mm(const MomentView& view) {
    const DepthImage depth_m = view.depth_of_pixels();
    cv::Mat1w depth(depth_m.size(), std::uint16_t{0});
    constexpr double mm = 1000, most_mm = 65535;
    for (int y = 0; y < depth.rows; ++y)
        for (int x = 0; x < depth.cols; ++x)
            if (const double value = depth_m(y, x) * mm; value > 0 && value <= most_mm)
                depth(y, x) = static_cast<std::uint16_t>(std::lround(value));
    return depth;
}

constexpr double half_px = 0.5;

nlohmann::ordered_json transform_of(const MomentView& view, const std::string& picture) {
    Eigen::Matrix4d pose = view.world_from_camera.matrix();
    // OpenGL's camera axes: y up and z backward.
    pose.col(1) *= -1;
    pose.col(2) *= -1;
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (int row = 0; row < 4; ++row)
        rows.push_back({pose(row, 0), pose(row, 1), pose(row, 2), pose(row, 3)});
    nlohmann::ordered_json json{{"file_path", "images/" + picture},
                                {"w", view.colour.cols},
                                {"h", view.colour.rows},
                                {"fl_x", view.K(0, 0)},
                                {"fl_y", view.K(1, 1)},
                                {"cx", view.K(0, 2) + half_px},
                                {"cy", view.K(1, 2) + half_px},
                                {"transform_matrix", rows}};
    if (!view.depth_m.empty()) json["depth_file_path"] = "depth/" + view.rig + ".png";
    return json;
}

}  // namespace

void write_training_folder(const Moment& moment, const std::filesystem::path& folder) {
    const std::filesystem::path model = folder / "sparse" / "0";
    for (const std::filesystem::path& each : {folder / "images", folder / "depth", model})
        make_folder(each);
    nlohmann::ordered_json transforms{{"camera_model", "PINHOLE"},
                                      {"depth_unit_scale_factor", 0.001},
                                      {"ply_file_path", "points.ply"}};
    std::string cameras = "# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n",
                images = "# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n",
                points = "# POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[]\n";
    int number = 0;
    for (const MomentView& view : moment.views) {
        ++number;
        const std::string picture =
            write_picture(view, folder / "images" / view.rig).filename().string();
        if (!view.depth_m.empty())
            write_grey_image(folder / "depth" / (view.rig + ".png"), depth_mm(view));
        transforms["frames"].push_back(transform_of(view, picture));
        cameras += fmt::format("{} PINHOLE {} {} {:.9g} {:.9g} {:.9g} {:.9g}\n", number,
                               view.colour.cols, view.colour.rows, view.K(0, 0), view.K(1, 1),
                               view.K(0, 2) + half_px, view.K(1, 2) + half_px);
        const Pose camera_from_world = view.world_from_camera.inverse();
        const Eigen::Quaterniond q(camera_from_world.linear());
        const Eigen::Vector3d t = camera_from_world.translation();
        // The second line of an image lists its features, and is empty.
        images +=
            fmt::format("{} {:.12g} {:.12g} {:.12g} {:.12g} {:.9g} {:.9g} {:.9g} {} {}\n\n", number,
                        q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z(), number, picture);
    }
    // Initial points for training: some ten thousand suffice.
    constexpr int step = 4;
    const std::vector<SurfacePoint> surface = surface_points(moment, step);
    std::size_t point = 0;
    for (const SurfacePoint& each : surface)
        points += fmt::format("{} {:.5f} {:.5f} {:.5f} {} {} {} 0\n", ++point, each.position_m[0],
                              each.position_m[1], each.position_m[2], each.rgb[0], each.rgb[1],
                              each.rgb[2]);
    write_text_atomically(model / "cameras.txt", cameras);
    write_text_atomically(model / "images.txt", images);
    write_text_atomically(model / "points3D.txt", points);
    write_ply(surface, folder / "points.ply");
    write_text_atomically(folder / "transforms.json", transforms.dump(1) + '\n');
}

void write_view_set(const Moment& moment, const std::filesystem::path& folder) {
    ViewSetWriter writer(folder);
    for (const MomentView& view : moment.views) {
        const std::filesystem::path picture = write_picture(view, folder / ".picture");
        writer.begin_view({view.rig, view.K, view.world_from_camera}, picture);
        std::error_code ignored;
        std::filesystem::remove(picture, ignored);
        if (view.depth_m.empty()) continue;
        DepthImage depth = view.depth_m.clone();
        // PFM marks unknown depth by a value that is not finite.
        depth.setTo(std::numeric_limits<float>::infinity(), depth <= 0);
        writer.add_depth(depth);
    }
    writer.finish();
}

}  // namespace vantage
