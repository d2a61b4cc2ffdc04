#include "host_app/view_sets/stage_views.h"

#include <opencv2/imgproc.hpp>

#include "common/av/video_reader.h"
#include "common/base/error.h"
#include "common/config/stage_cameras.h"
#include "common/image/image_file.h"

namespace vantage {
namespace {

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
