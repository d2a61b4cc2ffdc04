#include "host_app/foreground/motion/rig_agreement.h"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

/// Distance between two points that are checked, px of the grid.
constexpr int stride_px = 3;
/// A region with fewer answers is not checked. It is rejected if more than this share contradicts
/// it.
constexpr int min_answers = 12;
constexpr double max_against_share = 0.5;
/// Largest distance of a point's end from that in another rig: px of its grid, plus a share of the
/// length of the motion.
constexpr double max_error_px = 2, max_error_share = 0.3;
/// Matching error between two pulses, px of disparity: motion along the ray is known no finer.
constexpr double disparity_error_px = 1;

/// Maps between the grid of a rig's motion and space.
class Grid {
  public:
    explicit Grid(const FollowedRig& rig)
        : rig_(&rig),
          geometry_(rig.first->geometry),
          camera_from_world_(rig.first->world_from_camera.inverse()),
          size_(rig.motion->forward.size()),
          px_per_grid_(static_cast<double>(rig.first->colour.cols) / size_.width) {}

    cv::Size size() const { return size_; }
    const RigMotion& motion() const { return *rig_->motion; }

    /// Disparity, px of the colour picture; 0: unknown.
    double disparity_px(const RigFrame& frame, int x, int y) const {
        const cv::Point there = on_grid(x, y, size_, frame.disparity.size());
        return frame.disparity(there) / 32.0 * frame.colour.cols / frame.disparity.cols;
    }
    double first_px(int x, int y) const { return disparity_px(*rig_->first, x, y); }
    double second_px(int x, int y) const { return disparity_px(*rig_->second, x, y); }

    Eigen::Vector3d in_space(double x, double y, double disparity_px) const {
        const double z = geometry_.depth_m(disparity_px);
        const Eigen::Vector3d in_camera(
            ((x + 0.5) * px_per_grid_ - 0.5 - geometry_.cx_left_px) / geometry_.f_px * z,
            ((y + 0.5) * px_per_grid_ - 0.5 - geometry_.cy_px) / geometry_.f_px * z, z);
        return rig_->first->world_from_camera * in_camera;
    }

    /// Projects a point to the grid and to a disparity, px of the colour image. Returns false if it
    /// lies behind the camera.
    bool sees(const Eigen::Vector3d& point, Eigen::Vector2d& place, double& disparity_px) const {
        const Eigen::Vector3d in_camera = camera_from_world_ * point;
        if (in_camera.z() < 1e-3) return false;
        const double f = geometry_.f_px / in_camera.z();
        place = {(f * in_camera.x() + geometry_.cx_left_px + 0.5) / px_per_grid_ - 0.5,
                 (f * in_camera.y() + geometry_.cy_px + 0.5) / px_per_grid_ - 0.5};
        disparity_px = geometry_.disparity_px(in_camera.z());
        return true;
    }

  private:
    const FollowedRig* rig_;
    RectifiedStereo geometry_;
    Pose camera_from_world_;
    cv::Size size_;
    double px_per_grid_;
};

/// Returns the distance of a place from the line between two others.
double off_line(const Eigen::Vector2d& place, const Eigen::Vector2d& from,
                const Eigen::Vector2d& to) {
    const Eigen::Vector2d line = to - from;
    const double length2 = line.squaredNorm();
    const double along =
        length2 > 0 ? std::clamp((place - from).dot(line) / length2, 0.0, 1.0) : 0.0;
    return (place - from - along * line).norm();
}

enum class Answer { none, yes, no };

/// Whether `other` confirms that a point moves from a pixel of `asking` to `there`.
Answer answer_of(const Grid& asking, const Grid& other, cv::Point pixel, cv::Point there) {
    const double began_px = asking.first_px(pixel.x, pixel.y);
    const double ended_px = asking.second_px(there.x, there.y);
    const Eigen::Vector3d point = asking.in_space(pixel.x, pixel.y, began_px);
    Eigen::Vector2d place, near_end, far_end;
    double expected_px = 0, ignored = 0;
    if (!other.sees(point, place, expected_px)) return Answer::none;
    const cv::Point at(cvRound(place.x()), cvRound(place.y()));
    if (!cv::Rect({}, other.size()).contains(at)) return Answer::none;
    const double seen_px = other.first_px(at.x, at.y);
    // The point is hidden there, or another surface is seen.
    if (seen_px <= 0 || std::abs(seen_px - expected_px) > one_surface_steps / 32.0)
        return Answer::none;
    const RigMotion& motion = other.motion();
    if (!motion.is_followed(at)) return Answer::no;
    if (!motion.is_sure_first(at)) return Answer::none;
    const double farther_px = std::max(ended_px - disparity_error_px, 0.5 * ended_px);
    if (!other.sees(asking.in_space(there.x, there.y, ended_px + disparity_error_px), near_end,
                    ignored) ||
        !other.sees(asking.in_space(there.x, there.y, farther_px), far_end, ignored))
        return Answer::none;
    const cv::Vec2f way = motion.forward(at);
    const Eigen::Vector2d end(at.x + way[0], at.y + way[1]);
    const double off_px = off_line(end, near_end, far_end);
    return off_px <= max_error_px + max_error_share * std::hypot(way[0], way[1]) ? Answer::yes
                                                                                 : Answer::no;
}

/// Returns the regions of one rig that the others contradict.
std::vector<int> contradicted(const std::vector<Grid>& grids, std::size_t asking) {
    const Grid& grid = grids[asking];
    const RigMotion& motion = grid.motion();
    std::vector<int> answers(static_cast<std::size_t>(motion.regions)), against(answers.size());
    for (int y = stride_px / 2; y < grid.size().height; y += stride_px)
        for (int x = stride_px / 2; x < grid.size().width; x += stride_px) {
            const auto region = static_cast<std::size_t>(motion.region(y, x));
            const cv::Vec2f way = motion.forward(y, x);
            if (region == 0 || !motion.is_sure_first(y, x) || way == cv::Vec2f(0, 0)) continue;
            const cv::Point there(cvRound(x + way[0]), cvRound(y + way[1]));
            if (!cv::Rect({}, grid.size()).contains(there) || grid.first_px(x, y) <= 0 ||
                grid.second_px(there.x, there.y) <= 0)
                continue;
            for (std::size_t other = 0; other < grids.size(); ++other) {
                if (other == asking) continue;
                const Answer answer = answer_of(grid, grids[other], {x, y}, there);
                answers[region] += answer != Answer::none;
                against[region] += answer == Answer::no;
            }
        }
    std::vector<int> regions;
    for (std::size_t region = 1; region < answers.size(); ++region)
        if (answers[region] >= min_answers && against[region] > max_against_share * answers[region])
            regions.push_back(static_cast<int>(region));
    return regions;
}

}  // namespace

void agree_on_motion(const std::vector<FollowedRig>& rigs) {
    std::vector<Grid> grids;
    std::vector<RigMotion*> motions;
    for (const FollowedRig& rig : rigs) {
        if (rig.motion->empty() || rig.first->disparity.empty() || rig.second->disparity.empty())
            continue;
        grids.emplace_back(rig);
        motions.push_back(rig.motion);
    }
    // A rejected region may leave another rig's region without support: at most one round per rig.
    for (std::size_t round = 0; round < grids.size(); ++round) {
        std::vector<std::vector<int>> all;
        for (std::size_t asking = 0; asking < grids.size(); ++asking)
            all.push_back(contradicted(grids, asking));
        bool is_agreed = true;
        for (std::size_t rig = 0; rig < all.size(); ++rig) {
            leave_alone(*motions[rig], all[rig]);
            is_agreed = is_agreed && all[rig].empty();
        }
        if (is_agreed) return;
    }
}

}  // namespace vantage
