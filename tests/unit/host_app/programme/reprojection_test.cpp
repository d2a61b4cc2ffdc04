#include "host_app/programme/reprojection.h"

#include <cmath>

#include <gtest/gtest.h>

namespace vantage {
namespace {

constexpr int width_px = 320, height_px = 180;
const cv::Size size(width_px, height_px);
constexpr double wall_m = 8, board_m = 4;

/// Renders a wall and a board in front of it, each with its own pattern of waves.
struct CameraPicture {
    ColourImage picture{size};
    cv::Mat1f inverse_depth{size};
};

CameraPicture picture_from(const CameraState& camera) {
    CameraPicture seen;
    const Eigen::Matrix3d pixel_ray =
        camera.world_from_camera.linear() * camera.K(width_px, height_px).inverse();
    const Eigen::Vector3d at = camera.world_from_camera.translation();
    for (int y = 0; y < height_px; ++y)
        for (int x = 0; x < width_px; ++x) {
            const Eigen::Vector3d ray = pixel_ray * Eigen::Vector3d(x, y, 1);
            const auto hit = [&](double plane_m) -> Eigen::Vector3d {
                return at + (plane_m - at.z()) / ray.z() * ray;
            };
            Eigen::Vector3d surface = hit(board_m);
            const bool is_board = std::abs(surface.x()) < 0.6 && std::abs(surface.y()) < 0.5;
            if (!is_board) surface = hit(wall_m);
            const double wave = is_board ? 60 * std::sin(9 * surface.x())
                                         : 50 * std::cos(4 * surface.x() + 3 * surface.y());
            const auto level = cv::saturate_cast<unsigned char>((is_board ? 180 : 80) + wave);
            seen.picture(y, x) = {level, level, level, 255};
            const Eigen::Vector3d in_camera = camera.world_from_camera.inverse() * surface;
            seen.inverse_depth(y, x) = static_cast<float>(1 / in_camera.z());
        }
    return seen;
}

/// A camera that was turned to the right and moved.
CameraState camera_at(double x_m, double z_m = 0, double turn_rad = 0) {
    CameraState camera;
    camera.world_from_camera.linear() =
        Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
    camera.world_from_camera.translation() = Eigen::Vector3d(x_m, 0, z_m);
    return camera;
}

cv::Mat1f coarse(const cv::Mat1f& inverse_depth) {
    cv::Mat1f cells(height_px / 2, width_px / 2);
    for (int y = 0; y < cells.rows; ++y)
        for (int x = 0; x < cells.cols; ++x)
            cells(y, x) =
                std::max({inverse_depth(2 * y, 2 * x), inverse_depth(2 * y, 2 * x + 1),
                          inverse_depth(2 * y + 1, 2 * x), inverse_depth(2 * y + 1, 2 * x + 1)});
    return cells;
}

/// Mean difference of grey levels, without a margin that the first camera did not see.
double difference(const ColourImage& a, const ColourImage& b) {
    constexpr int margin_px = 16;
    double sum = 0;
    int pixels = 0;
    for (int y = margin_px; y < height_px - margin_px; ++y)
        for (int x = margin_px; x < width_px - margin_px; ++x, ++pixels)
            sum += std::abs(a(y, x)[0] - b(y, x)[0]);
    return sum / pixels;
}

/// Error of the first frame divided by the error of the reprojected frame.
double gain(const CameraState& from, const CameraState& to) {
    const CameraPicture first = picture_from(from), second = picture_from(to);
    const auto way = Reprojection::between(from, to, coarse(first.inverse_depth), size);
    if (!way) return 0;
    return difference(first.picture, second.picture) /
           difference(way->apply(first.picture), second.picture);
}

TEST(Reprojection, KeepsAFrameOfTheSameCamera) {
    const CameraPicture seen = picture_from(camera_at(0));
    const auto way =
        Reprojection::between(camera_at(0), camera_at(0), coarse(seen.inverse_depth), size);
    ASSERT_TRUE(way);
    EXPECT_LT(difference(way->apply(seen.picture), seen.picture), 0.01);
}

TEST(Reprojection, FollowsATurnAndATranslation) {
    EXPECT_GT(gain(camera_at(0), camera_at(0, 0, 0.03)), 8);
    EXPECT_GT(gain(camera_at(0), camera_at(0.1)), 5);
    EXPECT_GT(gain(camera_at(0), camera_at(0, 0.2)), 5);
    CameraState nearer = camera_at(0);
    nearer.field_of_view_rad *= 0.95;
    EXPECT_GT(gain(camera_at(0), nearer), 8);
}

TEST(Reprojection, KeepsTheOutlineWithTheForeground) {
    const CameraPicture first = picture_from(camera_at(0)), second = picture_from(camera_at(0.12));
    const auto way =
        Reprojection::between(camera_at(0), camera_at(0.12), coarse(first.inverse_depth), size);
    ASSERT_TRUE(way);
    const ColourImage carried = way->apply(first.picture);
    // Within one cell of the outline both surfaces are mixed.
    constexpr int cell_px = 2;
    for (int x = width_px / 4; x < width_px * 3 / 4; ++x)
        if (second.inverse_depth(height_px / 2, x - cell_px) > 0.2f &&
            second.inverse_depth(height_px / 2, x + cell_px) > 0.2f) {
            EXPECT_NEAR(carried(height_px / 2, x)[0], second.picture(height_px / 2, x)[0], 24)
                << "column " << x;
        }
}

TEST(Reprojection, EndsAtTheMaximumWay) {
    const cv::Mat1f depth = coarse(picture_from(camera_at(0)).inverse_depth);
    EXPECT_FALSE(Reprojection::between(camera_at(0), camera_at(2), depth, size));
    EXPECT_FALSE(Reprojection::between(camera_at(0), camera_at(0, 0, 3.1), depth, size));
    EXPECT_FALSE(Reprojection::between(camera_at(0), camera_at(0, 4), depth, size))
        << "a turn into the foreground";
    EXPECT_FALSE(Reprojection::between(camera_at(0), camera_at(0.1), {}, size)) << "no depth";
}

TEST(Reprojection, TreatsMissingDepthAsFarAway) {
    const cv::Mat1f nothing = cv::Mat1f::zeros(45, 80);
    const CameraPicture seen = picture_from(camera_at(0));
    const auto way = Reprojection::between(camera_at(0), camera_at(1), nothing, size);
    ASSERT_TRUE(way);
    EXPECT_LT(difference(way->apply(seen.picture), seen.picture), 0.01);
}

TEST(Reprojection, EstimatesTheShiftOfSurfaces) {
    CameraState camera = camera_at(0);
    camera.field_of_view_rad = 0.8;
    camera.focus_m = 4;
    EXPECT_DOUBLE_EQ(Reprojection::way(camera, camera), 0);
    CameraState turned = camera;
    turned.world_from_camera = camera_at(0, 0, 0.08).world_from_camera;
    EXPECT_NEAR(Reprojection::way(camera, turned), 0.1, 1e-9);
    CameraState aside = camera;
    aside.world_from_camera = camera_at(0.32).world_from_camera;
    EXPECT_NEAR(Reprojection::way(camera, aside), 0.1, 1e-9);
    CameraState zoomed = camera;
    zoomed.field_of_view_rad = 0.64;
    EXPECT_NEAR(Reprojection::way(camera, zoomed), 0.1, 1e-9);
}

}  // namespace
}  // namespace vantage
