#include "host_app/programme/reprojection.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

namespace vantage {
namespace {

constexpr int max_steps = 4;
/// Squared lengths of the last step, in px, below which the iteration ends and below which its
/// result counts as found.
constexpr float converged = 0.01f, found = 1;
/// Neighbourhood, in cells, that is searched for a nearer surface.
constexpr int foreground_cells = 9;
/// Rows that are looked up at a time.
constexpr int band_rows = 16;

/// Interpolates in a grid, clamped at its borders.
float bilinear(const cv::Mat1f& grid, float x, float y) {
    x = std::clamp(x, 0.0f, static_cast<float>(grid.cols - 1));
    y = std::clamp(y, 0.0f, static_cast<float>(grid.rows - 1));
    const int left = static_cast<int>(x), top = static_cast<int>(y);
    const int right = std::min(left + 1, grid.cols - 1);
    const float across = x - static_cast<float>(left), down = y - static_cast<float>(top);
    const float* above = grid[top];
    const float* below = grid[std::min(top + 1, grid.rows - 1)];
    return (1 - down) * ((1 - across) * above[left] + across * above[right]) +
           down * ((1 - across) * below[left] + across * below[right]);
}

/// For each pixel along one side of a picture: the two neighbouring cells of a grid and their
/// weights.
class GridMix {
  public:
    GridMix(int cells, int pixels) : between_(static_cast<std::size_t>(pixels)) {
        const float cells_per_px = static_cast<float>(cells) / static_cast<float>(pixels);
        for (std::size_t i = 0; i < between_.size(); ++i) {
            const float at = std::clamp((static_cast<float>(i) + 0.5f) * cells_per_px - 0.5f, 0.0f,
                                        static_cast<float>(cells - 1));
            const int first = static_cast<int>(at);
            between_[i] = {first, std::min(first + 1, cells - 1), at - static_cast<float>(first)};
        }
    }
    int first(int pixel) const { return at(pixel).first; }
    int second(int pixel) const { return at(pixel).second; }
    cv::Vec2f mixed(int pixel, const cv::Vec2f& first, const cv::Vec2f& second) const {
        return first + at(pixel).share_of_second * (second - first);
    }

  private:
    struct Between {
        int first, second;
        float share_of_second;
    };
    const Between& at(int pixel) const { return between_[static_cast<std::size_t>(pixel)]; }

    std::vector<Between> between_;
};

/// Computes for pixels of a second camera their place in the first camera's frame.
class SourceSearch {
  public:
    SourceSearch(const CameraState& from, const CameraState& to, const cv::Mat1f& inverse_depth,
                 cv::Size size)
        : px_per_cell_(static_cast<float>(size.width) / static_cast<float>(inverse_depth.cols),
                       static_cast<float>(size.height) / static_cast<float>(inverse_depth.rows)) {
        // The outline of a performer moves with the performer, and the background beside it is
        // stretched.
        cv::dilate(inverse_depth, nearest_, cv::Mat());
        cv::dilate(nearest_, before_, cv::Mat::ones(foreground_cells, foreground_cells, CV_8U));
        const Pose to_from = to.world_from_camera.inverse() * from.world_from_camera;
        const Eigen::Matrix3d K = to.K(size.width, size.height);
        turn_ = (K * to_from.linear() * from.K(size.width, size.height).inverse()).cast<float>();
        shift_ = (K * to_from.translation()).cast<float>();
    }

    /// Offset in px to the source of the centre of a cell; empty: behind the first camera.
    std::optional<Eigen::Vector2f> offset(int column, int row) const {
        const Eigen::Vector2f target = in_px(Eigen::Vector2i(column, row).cast<float>());
        // Where a performer moves in front of a wall both are solutions, so the nearer is tried
        // first.
        std::optional<Eigen::Vector2f> source;
        if (const auto miss = missed(target, target, before_(row, column)))
            source = found_from(target, target + *miss, true);
        if (!source) source = found_from(target, target, false);
        if (!source) return std::nullopt;
        return *source - target;
    }

  private:
    Eigen::Vector2f in_px(const Eigen::Vector2f& cell) const {
        return ((cell.array() + 0.5f) * px_per_cell_.array() - 0.5f).matrix();
    }
    /// Distance in the second camera's frame from the target to a pixel of the first one's frame
    /// with inverse depth `w`. Empty if the second camera does not see it.
    std::optional<Eigen::Vector2f> missed(const Eigen::Vector2f& target,
                                          const Eigen::Vector2f& source, float w) const {
        const Eigen::Vector3f seen = turn_ * source.homogeneous() + w * shift_;
        if (!(seen.z() > 0)) return std::nullopt;
        return target - seen.hnormalized();
    }
    /// Iterates from a start. Empty if a step fails, or if `must_end` and it does not converge.
    std::optional<Eigen::Vector2f> found_from(const Eigen::Vector2f& target, Eigen::Vector2f source,
                                              bool must_end) const {
        float left = found;
        for (int step = 0; step < max_steps && left > converged; ++step) {
            const Eigen::Array2f cell = (source.array() + 0.5f) / px_per_cell_.array() - 0.5f;
            const auto miss = missed(target, source, bilinear(nearest_, cell.x(), cell.y()));
            if (!miss) return std::nullopt;
            source += *miss;
            left = miss->squaredNorm();
        }
        if (must_end && left >= found) return std::nullopt;
        return source;
    }

    cv::Mat1f nearest_, before_;  ///< largest inverse depth near a cell, and in its neighbourhood
    Eigen::Vector2f px_per_cell_;
    /// The second camera sees a pixel s of the first picture, with inverse depth w, at
    /// turn * (s, 1) + w * shift.
    Eigen::Matrix3f turn_;
    Eigen::Vector3f shift_;
};

}  // namespace

std::optional<Reprojection> Reprojection::between(const CameraState& from, const CameraState& to,
                                                  const cv::Mat1f& inverse_depth, cv::Size size) {
    if (inverse_depth.empty()) return std::nullopt;
    const SourceSearch search(from, to, inverse_depth, size);
    const auto max_way_px = static_cast<float>(max_way * size.width);
    cv::Mat2f offsets(inverse_depth.size());
    for (int row = 0; row < offsets.rows; ++row)
        for (int column = 0; column < offsets.cols; ++column) {
            const std::optional<Eigen::Vector2f> offset = search.offset(column, row);
            if (!offset || !(offset->norm() <= max_way_px)) return std::nullopt;
            offsets(row, column) = {offset->x(), offset->y()};
        }
    return Reprojection(std::move(offsets), size);
}

double Reprojection::way(const CameraState& from, const CameraState& to) {
    const Pose between = from.world_from_camera.inverse() * to.world_from_camera;
    const double turn_rad = std::abs(Eigen::AngleAxisd(between.linear()).angle());
    const double aside_rad = between.translation().norm() / from.focus_m;
    const double zoom_rad = 0.5 * std::abs(to.field_of_view_rad - from.field_of_view_rad);
    return (std::max(turn_rad, aside_rad) + zoom_rad) / from.field_of_view_rad;
}

ColourImage Reprojection::apply(const ColourImage& picture, ColourImage carried) const {
    ColourImage resampled = picture;
    if (picture.size() != size_) cv::resize(picture, resampled, size_, 0, 0, cv::INTER_CUBIC);
    carried.create(size_);
    const GridMix across(offsets_.cols, size_.width), down(offsets_.rows, size_.height);
    // The positions of all pixels at once would take twice the memory of the frame.
    cv::Mat2f positions(band_rows, size_.width), row(1, offsets_.cols);
    for (int top = 0; top < size_.height; top += band_rows) {
        const cv::Range rows(top, std::min(top + band_rows, size_.height));
        for (int y = rows.start; y < rows.end; ++y) {
            for (int cell = 0; cell < row.cols; ++cell)
                row(cell) =
                    down.mixed(y, offsets_(down.first(y), cell), offsets_(down.second(y), cell));
            cv::Vec2f* const position = positions[y - top];
            for (int x = 0; x < size_.width; ++x)
                position[x] = across.mixed(x, row(across.first(x)), row(across.second(x))) +
                              cv::Vec2f(static_cast<float>(x), static_cast<float>(y));
        }
        ColourImage part = carried.rowRange(rows);
        cv::remap(resampled, part, positions.rowRange(0, rows.size()), cv::noArray(),
                  cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    }
    return carried;
}

}  // namespace vantage
