#include "host_app/baked/bake.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

#include "host_app/baked/depth_planes.h"
#include "host_app/baked/part_mesh.h"
#include "host_app/views/projection.h"

namespace vantage {
namespace {

/// Relative depth difference up to which the surfaces of two rigs are the same, beside the
/// uncertainty of stereo depth: as rendering has it (same_surface_share).
constexpr double same_share = 0.005;
/// Largest difference of the rigs' colours (0..1, mean of the channels) at one surface.
constexpr float alike = 0.06f;
/// Another rig's score must be larger by this factor to own a surface: otherwise it would change
/// from pixel to pixel where two rigs see it equally well.
constexpr double clearly_better = 1.05;
/// Share of the picture's smaller side within which a rig's colours fade out towards the border.
constexpr double border_share = 0.04;
/// Pixels by which the parts of two rigs overlap, so that no seam shows.
constexpr int overlap_px = 2;
/// Least weight of a view's resolution against that of the best view.
constexpr double min_resolution = 0.05;

float smooth(float from, float to, float x) {
    const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

/// Maps places in one depth map, px and 1/m, to those in another.
class PlaceMap {
  public:
    struct Place {
        double x = 0, y = 0, inverse = 0;  ///< inverse <= 0: behind the other camera
    };
    PlaceMap(const DepthView& from, const Eigen::Matrix3d& from_K, const DepthView& to,
             const Eigen::Matrix3d& to_K) {
        const Pose to_from = to.world_from_camera.inverse() * from.world_from_camera;
        turn_ = to_K * to_from.linear() * from_K.inverse();
        shift_ = to_K * to_from.translation();
    }
    Place of(double x, double y, double inverse) const {
        const Eigen::Vector3d q = turn_ * Eigen::Vector3d(x, y, 1) + shift_ * inverse;
        if (q.z() <= 0) return {};
        return {q.x() / q.z(), q.y() / q.z(), inverse / q.z()};
    }

  private:
    Eigen::Matrix3d turn_;
    Eigen::Vector3d shift_;
};

/// What one view says of a place that another one has measured.
struct Testimony {
    bool is_inside = false;     ///< in its picture, and not hidden from it
    bool supports = false;      ///< it has a surface there
    bool sees_through = false;  ///< it has measured a surface behind
    float sight = 0;            ///< how surely it sees that very surface, 0..1
    cv::Point at;               ///< the nearest pixel
};

struct BakeSource {
    const DepthView* view = nullptr;
    DepthPlanes planes;
    double spread = 0;
    cv::Mat1d score;  ///< how well the view sees the surface of each pixel
    cv::Mat1f border;

    explicit BakeSource(const DepthView& one)
        : view(&one), planes(one), spread(depth_spread(one)), border(planes.size()) {
        const cv::Size size = planes.size();
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x) {
                const double across = std::min(x + 0.5, size.width - x - 0.5) / size.width;
                const double down = std::min(y + 0.5, size.height - y - 0.5) / size.height;
                border(y, x) = smooth(0, static_cast<float>(border_share),
                                      static_cast<float>(std::min(across, down))) +
                               0.001f;
            }
    }

    Testimony testimony(const PlaceMap::Place& place) const {
        Testimony said;
        const cv::Size size = planes.size();
        if (place.inverse <= 0 || place.x < -0.5 || place.y < -0.5 || place.x > size.width - 0.5 ||
            place.y > size.height - 0.5)
            return said;
        const double tolerance = same_share + spread / place.inverse;
        const int x0 = static_cast<int>(std::floor(place.x)),
                  y0 = static_cast<int>(std::floor(place.y));
        said.at = {std::clamp(static_cast<int>(std::lround(place.x)), 0, size.width - 1),
                   std::clamp(static_cast<int>(std::lround(place.y)), 0, size.height - 1)};
        double nearest = 1e9;
        bool is_hidden = true, is_through = true;
        for (int k = 0; k < 4; ++k) {
            const int x = std::clamp(x0 + k % 2, 0, size.width - 1),
                      y = std::clamp(y0 + k / 2, 0, size.height - 1);
            const double inverse = planes.inverse(x, y);
            // Unknown depth says nothing: it counts as hidden.
            const double off = inverse > 0 ? place.inverse / inverse - 1 : -1;
            nearest = std::min(nearest, std::abs(off));
            is_hidden = is_hidden && off < -2 * tolerance;
            is_through =
                is_through && off > 2 * tolerance && planes.kind(x, y) == DepthPlanes::measured;
        }
        if (is_hidden) return said;
        said.is_inside = true;
        said.supports = nearest < 2 * tolerance;
        said.sees_through = !said.supports && is_through;
        said.sight = 1 - smooth(1, 2, static_cast<float>(nearest / tolerance));
        return said;
    }

    /// The colour of a pixel of the depth map.
    cv::Vec3f colour(int x, int y) const {
        const ColourImage& picture = view->colour;
        const cv::Size size = planes.size();
        const cv::Vec4b& c = picture((2 * y + 1) * picture.rows / (2 * size.height),
                                     (2 * x + 1) * picture.cols / (2 * size.width));
        return cv::Vec3f(c[0], c[1], c[2]) / 255;
    }

    void find_scores() {
        score = cv::Mat1d(planes.size(), 0.0);
        cv::Mat1d count(planes.size(), 1e-9);
        for (int y = 0; y < score.rows; ++y)
            for (int x = 0; x < score.cols; ++x)
                if (planes.kind(x, y) == DepthPlanes::measured) {
                    score(y, x) = planes.pixels_per_square_m(x, y) * border(y, x);
                    count(y, x) = 1;
                }
        // Slopes are noisy, and parts shall have simple outlines.
        const int window_px = std::max(score.cols / 16, 3);
        cv::blur(score, score, {window_px, window_px});
        cv::blur(count, count, {window_px, window_px});
        score /= count;
    }
};

/// Whether the rigs' depths and colours speak for a pixel's surface (fused_depth.frag).
bool is_consistent(const std::vector<BakeSource>& sources, std::size_t own, int x, int y,
                   std::span<const PlaceMap> maps) {
    const BakeSource& source = sources[own];
    int supporting = 1, through = 0;
    cv::Vec3f least = source.colour(x, y), most = least;
    for (std::size_t j = 0; j < sources.size(); ++j) {
        if (j == own) continue;
        const Testimony said = sources[j].testimony(maps[j].of(x, y, source.planes.inverse(x, y)));
        if (!said.is_inside) continue;
        supporting += said.supports ? 1 : 0;
        through += said.sees_through ? 1 : 0;
        const cv::Vec3f colour = sources[j].colour(said.at.x, said.at.y);
        for (int c = 0; c < 3; ++c) {
            least[c] = std::min(least[c], colour[c]);
            most[c] = std::max(most[c], colour[c]);
        }
    }
    const bool is_guess = source.planes.kind(x, y) == DepthPlanes::inpainted;
    if (through == 0) return true;
    if (is_guess) return false;
    if (through != supporting) return through < supporting;
    return (most[0] - least[0] + most[1] - least[1] + most[2] - least[2]) / 3 < alike;
}

/// The most useful views for a part, the owner first: those at the smallest angles to its own.
std::array<int, BakedPart::max_sources> sources_of(const std::vector<BakeSource>& sources,
                                                   std::size_t own) {
    std::vector<int> others;
    const auto axis = [&](std::size_t i) {
        return sources[i].view->world_from_camera.linear().col(2).eval();
    };
    for (std::size_t j = 0; j < sources.size(); ++j)
        if (j != own) others.push_back(static_cast<int>(j));
    std::stable_sort(others.begin(), others.end(), [&](int a, int b) {
        return axis(own).dot(axis(static_cast<std::size_t>(a))) >
               axis(own).dot(axis(static_cast<std::size_t>(b)));
    });
    std::array<int, BakedPart::max_sources> all{static_cast<int>(own), -1, -1, -1};
    for (std::size_t k = 1; k < all.size() && k - 1 < others.size(); ++k) all[k] = others[k - 1];
    return all;
}

/// The pixels of a kind that a view owns, as 0 or 255.
cv::Mat1b owned_by(const std::vector<BakeSource>& sources, std::size_t own,
                   std::span<const PlaceMap> maps, DepthPlanes::Kind kind) {
    const DepthPlanes& planes = sources[own].planes;
    cv::Mat1b owned(planes.size(), uchar{0});
    for (int y = 0; y < owned.rows; ++y)
        for (int x = 0; x < owned.cols; ++x) {
            if (planes.kind(x, y) != kind) continue;
            const double score = sources[own].score(y, x);
            bool is_own = true;
            for (std::size_t j = 0; j < sources.size() && is_own; ++j) {
                if (j == own) continue;
                const Testimony said = sources[j].testimony(maps[j].of(x, y, planes.inverse(x, y)));
                if (said.sight < 0.5f) continue;
                const DepthPlanes::Kind its = sources[j].planes.kind(said.at.x, said.at.y);
                if (its == DepthPlanes::measured)
                    is_own = kind == DepthPlanes::measured &&
                             sources[j].score(said.at) <= clearly_better * score;
                else if (its == DepthPlanes::inpainted && kind == DepthPlanes::inpainted)
                    is_own = own < j;
            }
            if (is_own) owned(y, x) = 255;
        }
    return owned;
}

/// The owned pixels with simpler outlines, and with those around that let parts overlap.
cv::Mat1b rounded(const cv::Mat1b& owned, const DepthPlanes& planes, DepthPlanes::Kind kind) {
    cv::Mat1b of_kind(owned.size(), uchar{0});
    for (int y = 0; y < owned.rows; ++y)
        for (int x = 0; x < owned.cols; ++x)
            if (planes.kind(x, y) == kind) of_kind(y, x) = 255;
    cv::Mat1b wide;
    const int side = 2 * overlap_px + 1;
    cv::dilate(owned, wide, cv::Mat1b::ones(side, side));
    return wide & of_kind;
}

ColourImage weights_of(const std::vector<BakeSource>& sources,
                       const std::array<int, BakedPart::max_sources>& used,
                       std::span<const PlaceMap> maps) {
    const auto own = static_cast<std::size_t>(used[0]);
    const DepthPlanes& planes = sources[own].planes;
    ColourImage weights(planes.size(), cv::Vec4b(0, 0, 0, 0));
    for (int y = 0; y < weights.rows; ++y)
        for (int x = 0; x < weights.cols; ++x) {
            if (planes.kind(x, y) == DepthPlanes::unknown) continue;
            std::array<double, BakedPart::max_sources> sight{}, pixels{};
            sight[0] = sources[own].border(y, x);
            pixels[0] = planes.pixels_per_square_m(x, y);
            for (std::size_t k = 1; k < used.size(); ++k) {
                if (used[k] < 0) continue;
                const auto j = static_cast<std::size_t>(used[k]);
                const Testimony said = sources[j].testimony(maps[j].of(x, y, planes.inverse(x, y)));
                if (said.sight <= 0) continue;
                sight[k] = static_cast<double>(said.sight * sources[j].border(said.at));
                pixels[k] = sources[j].planes.pixels_per_square_m(said.at.x, said.at.y);
            }
            const double best = *std::max_element(pixels.begin(), pixels.end());
            for (std::size_t k = 0; k < used.size(); ++k) {
                const double resolution =
                    best > 0 ? std::max(min_resolution, pixels[k] / best) : 1.0;
                weights(y, x)[static_cast<int>(k)] =
                    sight[k] > 0
                        ? cv::saturate_cast<uchar>(std::max(1.0, 255 * sight[k] * resolution))
                        : uchar{0};
            }
        }
    return weights;
}

/// Gives pixels without weights those of a neighbour, for the interpolation at a surface's edge.
void extend(ColourImage& weights) {
    const ColourImage before = weights.clone();
    const cv::Rect all({0, 0}, weights.size());
    for (int y = 0; y < weights.rows; ++y)
        for (int x = 0; x < weights.cols; ++x) {
            if (before(y, x) != cv::Vec4b(0, 0, 0, 0)) continue;
            for (const cv::Point off :
                 {cv::Point(-1, 0), cv::Point(1, 0), cv::Point(0, -1), cv::Point(0, 1)}) {
                const cv::Point at = cv::Point(x, y) + off;
                if (all.contains(at) && before(at) != cv::Vec4b(0, 0, 0, 0))
                    weights(y, x) = before(at);
            }
        }
}

/// Pixels by which places move in the picture of the nearest other view, for each 1/m.
double parallax_of(const std::vector<BakeSource>& sources, std::size_t own) {
    const Eigen::Vector3d centre = sources[own].view->world_from_camera.translation();
    double nearest_m = 0;
    for (std::size_t j = 0; j < sources.size(); ++j) {
        const double away_m = (sources[j].view->world_from_camera.translation() - centre).norm();
        if (j != own && away_m > 0 && (nearest_m == 0 || away_m < nearest_m)) nearest_m = away_m;
    }
    if (nearest_m == 0) nearest_m = std::max(sources[own].view->baseline_m, 0.1);
    return sources[own].planes.K()(0, 0) * nearest_m;
}

BakedPart part_of(const std::vector<BakeSource>& sources, std::size_t own,
                  std::span<const PlaceMap> maps) {
    BakedPart part;
    part.sources = sources_of(sources, own);
    part.weights = weights_of(sources, part.sources, maps);
    extend(part.weights);
    const DepthPlanes& planes = sources[own].planes;
    const double parallax_px = parallax_of(sources, own);
    for (const DepthPlanes::Kind kind : {DepthPlanes::measured, DepthPlanes::inpainted}) {
        const PartMesh mesh = part_mesh(
            planes, rounded(owned_by(sources, own, maps, kind), planes, kind), parallax_px);
        const auto first = static_cast<std::uint32_t>(part.vertices.size());
        part.vertices.insert(part.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
        for (const std::uint32_t index : mesh.indices) part.indices.push_back(first + index);
        if (kind == DepthPlanes::measured) part.measured = part.indices.size();
    }
    return part;
}

}  // namespace

std::optional<BakedBackground> bake_background(std::span<const DepthView> views,
                                               const std::stop_token& stop) {
    std::vector<BakeSource> sources;
    for (const DepthView& view : views) {
        if (stop.stop_requested()) return std::nullopt;
        sources.emplace_back(view);
    }
    std::vector<std::vector<PlaceMap>> maps;
    for (const BakeSource& from : sources) {
        maps.emplace_back();
        for (const BakeSource& to : sources)
            maps.back().emplace_back(*from.view, from.planes.K(), *to.view, to.planes.K());
    }
    std::vector<std::vector<cv::Point>> refused(sources.size());
    for (std::size_t i = 0; i < sources.size(); ++i) {
        if (stop.stop_requested()) return std::nullopt;
        const cv::Size size = sources[i].planes.size();
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
                if (sources[i].planes.kind(x, y) != DepthPlanes::unknown &&
                    !is_consistent(sources, i, x, y, maps[i]))
                    refused[i].emplace_back(x, y);
    }
    BakedBackground baked;
    for (std::size_t i = 0; i < sources.size(); ++i) {
        for (const cv::Point& at : refused[i]) sources[i].planes.drop(at.x, at.y);
        sources[i].find_scores();
    }
    for (std::size_t i = 0; i < sources.size(); ++i) {
        if (stop.stop_requested()) return std::nullopt;
        baked.parts.push_back(part_of(sources, i, maps[i]));
        DepthView view = views[i];
        view.colour = views[i].colour.clone();
        cv::insertChannel(edge_confidence_of(views[i].depth_m, view.colour.size()), view.colour, 3);
        view.depth_m.release();
        baked.views.push_back(std::move(view));
    }
    return baked;
}

}  // namespace vantage
