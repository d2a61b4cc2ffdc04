#include "host_app/exports/moment.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

#include "common/base/log.h"
#include "host_app/views/depth_view.h"
#include "host_app/views/projection.h"

namespace vantage {
namespace {

/// Neighbouring pixels belong to one surface if their depths differ by less than this share of the
/// nearer one. A larger step within one surface would be steeper than 80 degrees at a rig's usual
/// field of view.
constexpr float one_surface_share = 0.03f;

/// The depth of a frame; empty if it has no disparity.
DepthImage depth_of(const RigFrame& frame) {
    const DepthView view = depth_view_of(frame);
    DepthImage depth(view.depth_size());
    for (int y = 0; y < depth.rows; ++y)
        for (int x = 0; x < depth.cols; ++x) depth(y, x) = view.depth_m_at(x, y);
    return depth;
}

}  // namespace

Eigen::Matrix3d MomentView::depth_K() const {
    return scaled_intrinsics(K, static_cast<double>(depth_m.cols) / colour.cols,
                             static_cast<double>(depth_m.rows) / colour.rows);
}

DepthImage MomentView::depth_of_pixels() const {
    if (depth_m.empty() || depth_m.size() == colour.size()) return depth_m;
    DepthImage depth;
    cv::resize(depth_m, depth, colour.size(), 0, 0, cv::INTER_NEAREST);
    return depth;
}

std::vector<SurfacePoint> surface_points(const Moment& moment, int step) {
    std::vector<SurfacePoint> points;
    for (const MomentView& view : moment.views) {
        const Eigen::Matrix3d rays = view.depth_K().inverse();
        for (int y = 0; y < view.depth_m.rows; y += step)
            for (int x = 0; x < view.depth_m.cols; x += step) {
                const double z = view.depth_m(y, x);
                if (z <= 0) continue;
                const Eigen::Vector3d at =
                    view.world_from_camera * (z * (rays * Eigen::Vector3d(x, y, 1)));
                const cv::Vec4b colour = view.colour(y * view.colour.rows / view.depth_m.rows,
                                                     x * view.colour.cols / view.depth_m.cols);
                points.push_back({at.cast<float>(), {colour[0], colour[1], colour[2]}});
            }
    }
    return points;
}

std::vector<std::array<std::uint32_t, 3>> surface_triangles(const Moment& moment) {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::uint32_t points = 0;
    for (const MomentView& view : moment.views) {
        cv::Mat1i numbers(view.depth_m.size(), 0);
        for (int y = 0; y < numbers.rows; ++y)
            for (int x = 0; x < numbers.cols; ++x)
                if (view.depth_m(y, x) > 0) numbers(y, x) = static_cast<int>(points++);
        const auto join = [&](cv::Point a, cv::Point b, cv::Point c) {
            const auto [near, far] =
                std::minmax({view.depth_m(a), view.depth_m(b), view.depth_m(c)});
            if (near <= 0 || far > near * (1 + one_surface_share)) return;
            const auto number = [&](cv::Point at) {
                return static_cast<std::uint32_t>(numbers(at));
            };
            triangles.push_back({number(a), number(b), number(c)});
        };
        for (int y = 0; y + 1 < numbers.rows; ++y)
            for (int x = 0; x + 1 < numbers.cols; ++x) {
                const cv::Point here(x, y), right(x + 1, y), below(x, y + 1), across(x + 1, y + 1);
                join(here, below, right);
                join(right, below, across);
            }
    }
    return triangles;
}

MomentReader::MomentReader(const TakeReader& take)
    : take_(take), show_(take_show_from(take.facts().show)) {
    for (const TakeRig& rig : take.facts().rigs) restorers_.emplace_back(rig);
}

Moment MomentReader::at(std::uint64_t pulse) {
    Moment moment;
    moment.pulse = pulse;
    moment.pulse_rate_hz = take_.facts().pulse_rate_hz;
    for (std::size_t rig = 0; rig < restorers_.size(); ++rig) {
        const std::vector<TakeReader::Frame>& frames = take_.frames(rig);
        const auto there =
            std::lower_bound(frames.begin(), frames.end(), pulse,
                             [](const TakeReader::Frame& frame, std::uint64_t wanted) {
                                 return frame.pulse < wanted;
                             });
        if (there == frames.end() || there->pulse != pulse) continue;
        try {
            StoredFrame stored = take_.load(rig, *there);
            const RigFrame frame = restorers_[rig].restore(stored);
            if (frame.colour.empty()) continue;
            MomentView view;
            view.rig = take_.facts().rigs[rig].name;
            const auto correction = show_.colours.find(view.rig);
            const bool is_stages =
                correction == show_.colours.end() || correction->second.is_identity();
            view.colour = is_stages ? frame.colour : correction->second.apply(frame.colour);
            if (is_stages && take_.facts().rigs[rig].colour.codec == TakePictures::Codec::jpeg)
                view.jpeg = std::move(stored.colour);
            view.depth_m = depth_of(frame);
            view.K = frame.geometry.K_left();
            view.world_from_camera = frame.world_from_camera;
            moment.views.push_back(std::move(view));
        } catch (const TakeDamaged& error) {
            log_warning("{}", error.what());
            ++moment.damaged;
        }
    }
    return moment;
}

}  // namespace vantage
