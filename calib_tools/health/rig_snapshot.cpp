#include "calib_tools/health/rig_snapshot.h"

#include <algorithm>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "common/base/error.h"
#include "common/config/calibration_file.h"
#include "common/geometry/rectification_map.h"
#include "common/image/image_file.h"
#include "common/image/picture_list.h"
#include "common/rectification/rectify_reference.h"

namespace vantage {
namespace {

constexpr double nearest_m = 0.7;  // nearer surfaces are not on the stage
constexpr int block_px = 5;

/// Number of disparities down to nearest_m; the matcher needs a multiple of 16.
int disparity_count(const RectifiedStereo& geometry) {
    const double most = geometry.disparity_px(nearest_m);
    const int limit = std::max(16, geometry.width_px / 3 / 16 * 16);
    return std::clamp(static_cast<int>(most / 16 + 1) * 16, 16, limit);
}

DepthImage match(const ColourImage& left, const ColourImage& right,
                 const RectifiedStereo& geometry) {
    const cv::Ptr<cv::StereoSGBM> matcher =
        cv::StereoSGBM::create(0, disparity_count(geometry), block_px, 8 * block_px * block_px,
                               32 * block_px * block_px, 1, 31, 10, 100, 1);
    cv::Mat1s steps;
    matcher->compute(to_grey(left), to_grey(right), steps);
    DepthImage depth_m(steps.size(), 0.0f);
    for (int y = 0; y < steps.rows; ++y)
        for (int x = 0; x < steps.cols; ++x)
            if (steps(y, x) > 0)
                depth_m(y, x) = static_cast<float>(geometry.depth_m(
                    steps(y, x) / static_cast<double>(cv::StereoMatcher::DISP_SCALE)));
    return depth_m;
}

void require_size(const std::string& rig, const char* side, const ColourImage& picture,
                  const CameraModel& camera) {
    if (picture.cols != camera.width_px || picture.rows != camera.height_px)
        fail("rig {}: the {} picture is {}x{} and its calibration is for {}x{}", rig, side,
             picture.cols, picture.rows, camera.width_px, camera.height_px);
}

}  // namespace

OverlapView RigSnapshot::overlap_view() const {
    OverlapView view;
    view.name = name;
    view.colour = left;
    view.depth_m = depth_m;
    view.K = calibration.rectified.K_left();
    view.world_from_camera = calibration.world_from_rectified_left();
    view.baseline_m = calibration.rectified.baseline_m;
    return view;
}

RigSnapshot make_snapshot(const std::string& name, const StereoCalibration& calibration,
                          const ColourImage& raw_left, const ColourImage& raw_right) {
    require_size(name, "left", raw_left, calibration.left);
    require_size(name, "right", raw_right, calibration.right);
    RigSnapshot snapshot;
    snapshot.name = name;
    snapshot.calibration = calibration;
    const auto rectified = [&](const ColourImage& raw, Side side) {
        return is_identity(calibration, side)
                   ? raw
                   : rectify_reference(raw, make_rectification_map(calibration, side));
    };
    snapshot.left = rectified(raw_left, Side::left);
    snapshot.right = rectified(raw_right, Side::right);
    snapshot.depth_m = match(snapshot.left, snapshot.right, calibration.rectified);
    return snapshot;
}

RigSnapshot load_snapshot(const std::string& name, const std::filesystem::path& folder,
                          long long instant) {
    const std::filesystem::path file = folder / "calibration.yaml";
    const StereoCalibration calibration = load_calibration(file);
    const auto left = expand_pictures((folder / "left*").string());
    const auto right = expand_pictures((folder / "right*").string());
    const PicturePairs pairs = pair_pictures(left, right);
    if (pairs.pairs.empty()) fail("{} holds no pair of left and right pictures", folder.string());
    std::size_t chosen = 0;
    if (instant >= 0) {
        std::vector<std::filesystem::path> lefts;
        for (const auto& [l, r] : pairs.pairs) lefts.push_back(l);
        const std::vector<long long> numbers = picture_numbers(lefts);
        const auto found = std::find(numbers.begin(), numbers.end(), instant);
        if (found == numbers.end())
            fail("{} holds no pair with the number {}", folder.string(), instant);
        chosen = static_cast<std::size_t>(found - numbers.begin());
    }
    const auto [raw_left, raw_right] =
        read_colour_pair(pairs.pairs[chosen].first, pairs.pairs[chosen].second);
    RigSnapshot snapshot = make_snapshot(name, calibration, raw_left, raw_right);
    snapshot.calibration_date = load_calibration_record(file).date;
    return snapshot;
}

}  // namespace vantage
