#include "calib_tools/health/stage_health.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/LU>
#include <fmt/ranges.h>
#include <opencv2/imgproc.hpp>

#include "calib_tools/colour/cielab.h"
#include "calib_tools/colour/overlap.h"
#include "calib_tools/health/patch_search.h"
#include "calib_tools/rig/pair_solver.h"
#include "common/base/error.h"
#include "common/board/median.h"
#include "common/image/image_file.h"

namespace vantage {
namespace {

/// Feature of rig b's image and its distance from the epipolar line in rig a's image. The distance
/// comes from the rigs' poses, whatever the depth of the feature.
struct TrackedPlace {
    Eigen::Vector2d b_px;
    double miss_px = 0;
};

constexpr int half_patch_px = 7, patch_px = 2 * half_patch_px + 1;
constexpr double good_match = 0.85;
constexpr double surface_share =
    0.04;  ///< a patch is on one surface if its depths differ by less than this share
constexpr double hidden_share = 0.1;
constexpr double fewest_known = 0.8;  ///< share of the patch's depths that are known
constexpr int reach_share = 32;       ///< share of the image width

/// Renders a's image as b sees the patch around (x, y), with b's depth. Empty if a part of it is
/// unknown, on another surface or outside a's image, or if a sees something nearer.
std::optional<GreyImage> patch_from(const OverlapView& a, const GreyImage& a_grey,
                                    const OverlapView& b, const Pose& a_from_b, int x, int y) {
    const float middle_m = b.depth_m(y, x);
    if (!(middle_m > 0)) return std::nullopt;
    const Eigen::Matrix3d ray_from_pixel = b.K.inverse();
    cv::Mat2f places(patch_px, patch_px);
    int known = 0;
    for (int dy = -half_patch_px; dy <= half_patch_px; ++dy)
        for (int dx = -half_patch_px; dx <= half_patch_px; ++dx) {
            float depth_m = b.depth_m(y + dy, x + dx);
            if (depth_m > 0) {
                if (std::abs(depth_m - middle_m) > surface_share * middle_m) return std::nullopt;
                ++known;
            } else {
                depth_m = middle_m;
            }
            const Eigen::Vector3d in_a =
                a_from_b * (depth_m * (ray_from_pixel * Eigen::Vector3d(x + dx, y + dy, 1)));
            if (!(in_a.z() > 0)) return std::nullopt;
            const Eigen::Vector3d pixel = a.K * in_a / in_a.z();
            if (pixel.x() < 1 || pixel.y() < 1 || pixel.x() > a_grey.cols - 2 ||
                pixel.y() > a_grey.rows - 2)
                return std::nullopt;
            if (dx == 0 && dy == 0) {
                const float seen_m = a.depth_m(static_cast<int>(std::lround(pixel.y())),
                                               static_cast<int>(std::lround(pixel.x())));
                if (seen_m > 0 && std::abs(seen_m - in_a.z()) > hidden_share * in_a.z())
                    return std::nullopt;
            }
            places(dy + half_patch_px, dx + half_patch_px) =
                cv::Vec2f(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
        }
    if (known < fewest_known * patch_px * patch_px) return std::nullopt;
    GreyImage patch;
    cv::remap(a_grey, patch, places, cv::noArray(), cv::INTER_LINEAR);
    return patch;
}

/// Tracks up to `most` corners of b's image in a's image: a's image is warped to b's view with b's
/// depth, and compared near the corner. The offset along the epipolar line belongs to the depth
/// measure, since an error of depth cannot be distinguished from one of pose there.
std::vector<TrackedPlace> track_places(const OverlapView& a, const OverlapView& b, int most) {
    constexpr double quality = 0.02;
    const GreyImage a_grey = to_grey(a.colour), b_grey = to_grey(b.colour);
    std::vector<cv::Point2f> corners;
    cv::goodFeaturesToTrack(b_grey, corners, most, quality, half_patch_px);
    const Pose a_from_b = a.world_from_camera.inverse() * b.world_from_camera;
    const Eigen::Vector3d epipole = b.K * a_from_b.inverse().translation();
    const int reach = std::max(6, b_grey.cols / reach_share), margin = half_patch_px + reach;
    std::vector<TrackedPlace> tracked;
    for (const cv::Point2f& corner : corners) {
        const int x = static_cast<int>(std::lround(corner.x));
        const int y = static_cast<int>(std::lround(corner.y));
        if (x < margin || y < margin || x >= b_grey.cols - margin || y >= b_grey.rows - margin)
            continue;
        const std::optional<GreyImage> patch = patch_from(a, a_grey, b, a_from_b, x, y);
        if (!patch) continue;
        const cv::Rect area(x - margin, y - margin, 2 * margin + 1, 2 * margin + 1);
        const std::optional<Eigen::Vector2d> found = find_patch(b_grey(area), *patch, good_match);
        if (!found) continue;
        const Eigen::Vector2d pixel(x, y);
        const Eigen::Vector2d along = epipole.head<2>() - epipole.z() * pixel;
        if (!(along.norm() > 0)) continue;
        const Eigen::Vector2d across = Eigen::Vector2d(-along.y(), along.x()).normalized();
        tracked.push_back({pixel, (*found - Eigen::Vector2d(reach, reach)).dot(across)});
    }
    return tracked;
}

constexpr int features = 400, overlap_places = 3000;
constexpr int fewest_rows = 20, fewest_overlap = 50;
// Matching errors start to rise at 0.3 px; beyond 1 px whole surfaces are lost.
constexpr double row_warn_px = 0.3, row_bad_px = 0.8;
// A matcher may err by several tenths of a pixel in places, but not over whole fields at once.
constexpr double depth_warn_share = 0.01, matcher_bias_px = 0.3, bad_times_warn = 3;
constexpr double colour_warn = 2.0, colour_bad = 5.0;
// Two depths that differ by more belong to two surfaces.
constexpr double same_surface_share = 0.15;
constexpr double through_warn_percent = 5;
constexpr int fields_a_side = 4, fewest_in_field = 8;
// Patches seen from two sides are located to a few tenths of a pixel. A good calibration of a stage
// is as accurate as that in small images; in large ones the angle of a pixel limits it.
constexpr int fewest_places = 10, fewest_places_in_field = 3;
constexpr double place_warn_px = 0.5, place_warn_share_of_width = 0.0007;

/// Sets the verdict of a measure: unknown with the sentence `too_few` for fewer samples than
/// `fewest`; with the sentence `not_good` if it is not good.
HealthMeasure judged(HealthMeasure m, int fewest, std::string_view too_few, std::string not_good) {
    if (m.samples < fewest) {
        m.verdict = Verdict::unknown;
        m.sentence = fmt::format("{} of {}: unknown, {} ({} places, {} are needed)", m.what, m.rigs,
                                 too_few, m.samples, fewest);
        return m;
    }
    m.verdict = m.value >= m.bad_at    ? Verdict::bad
                : m.value >= m.warn_at ? Verdict::warn
                                       : Verdict::good;
    if (m.verdict != Verdict::good) m.sentence = std::move(not_good);
    return m;
}

HealthMeasure measure_rows(const RigSnapshot& rig, const std::vector<TrackedRow>& rows) {
    std::vector<double> misses;
    misses.reserve(rows.size());
    for (const TrackedRow& row : rows) misses.push_back(std::abs(row.row_miss_px));
    std::sort(misses.begin(), misses.end());
    misses.resize(misses.size() - misses.size() / 10);
    const double rms_px = root_mean_square(misses);
    return judged(
        {"rows", rig.name, rms_px, "px", row_warn_px, row_bad_px, static_cast<int>(rows.size())},
        fewest_rows, "too few features to follow from the left to the right picture",
        fmt::format("the rows of rig {} miss each other by {:.2f} px: a camera or lens has moved "
                    "on its rig; calibrate it again (stereo)",
                    rig.name, rms_px));
}

/// Values grouped by fields of the image. Noise has no preferred sign; a rig that was moved causes
/// one, though not the same in every field.
class Fields {
  public:
    explicit Fields(const cv::Size& size) : size_(size) {}

    void add(const Eigen::Vector2d& pixel, double value) {
        values_[place(pixel.y(), size_.height)][place(pixel.x(), size_.width)].push_back(value);
    }
    /// Median of every field with at least `fewest` values.
    std::vector<double> medians(std::size_t fewest) const {
        std::vector<double> medians;
        for (const auto& row : values_)
            for (const std::vector<double>& field : row)
                if (field.size() >= fewest) medians.push_back(median(field));
        return medians;
    }

  private:
    static int place(double at, int size_px) {
        return std::clamp(static_cast<int>(at * fields_a_side / size_px), 0, fields_a_side - 1);
    }
    cv::Size size_;
    std::vector<double> values_[fields_a_side][fields_a_side];
};

/// Depth differences of two rigs by fields of the image, compared with the effect of the matcher's
/// bias on depth in the same fields.
HealthMeasure measure_depth(const std::string& names, const cv::Size& size,
                            const std::vector<const OverlapSample*>& samples) {
    Fields shares(size), bias_shares(size);
    int count = 0;
    for (const OverlapSample* s : samples) {
        const double share = (s->measured_m - s->predicted_m) / s->predicted_m;
        if (std::abs(share) > same_surface_share) continue;
        ++count;
        shares.add(s->b_px, share);
        const double bias_share =
            s->disparity_miss != 0 ? std::abs(share / s->disparity_miss) * matcher_bias_px : 0;
        bias_shares.add(s->b_px, std::max(depth_warn_share, bias_share));
    }
    const double warn_percent =
        100 * std::max(depth_warn_share, root_mean_square(bias_shares.medians(fewest_in_field)));
    const double apart_percent = 100 * root_mean_square(shares.medians(fewest_in_field));
    return judged({"depth", names, apart_percent, "% of depth", warn_percent,
                   bad_times_warn * warn_percent, count},
                  fewest_overlap, "the two rigs see too little of the same surfaces",
                  fmt::format("rigs {} see one surface {:.1f} % of its depth apart: one of them "
                              "has been moved; place them again (stage)",
                              names, apart_percent));
}

/// Share of the surfaces of one rig behind which the other rig sees something farther. A front
/// surface cannot be hidden: only a wrong pose or a wrong match shows a surface that another rig
/// sees through. The worse of the two directions counts.
HealthMeasure measure_through(const std::vector<RigSnapshot>& rigs, int a, int b,
                              const std::vector<OverlapSample>& overlap) {
    const auto name = [&](int rig) { return rigs[static_cast<std::size_t>(rig)].name; };
    HealthMeasure worst{
        "through",     name(a) + "-" + name(b), 0,
        "% of places", through_warn_percent,    bad_times_warn * through_warn_percent};
    std::string sentence;
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
        int all = 0, through = 0;
        for (const OverlapSample& s : overlap)
            if (s.a == from && s.b == to) {
                ++all;
                if (s.measured_m > (1 + same_surface_share) * s.predicted_m) ++through;
            }
        const double percent = all > 0 ? 100.0 * through / all : 0;
        if (all < fewest_overlap || (worst.samples > 0 && percent <= worst.value)) continue;
        worst.value = percent;
        worst.samples = all;
        sentence = fmt::format(
            "rig {} sees through {:.0f} % of the surfaces that rig {} shows it: one of them has "
            "been moved; place them again (stage)",
            name(to), percent, name(from));
    }
    return judged(std::move(worst), fewest_overlap,
                  "the two rigs see too little of the same surfaces", std::move(sentence));
}

/// Distances of features from their epipolar lines, from each of two rigs into the other.
HealthMeasure measure_place(const RigSnapshot& a, const RigSnapshot& b, const std::string& names) {
    std::vector<double> medians;
    int count = 0;
    for (const auto& [from, to] : {std::pair(&a, &b), std::pair(&b, &a)}) {
        Fields fields(to->left.size());
        for (const TrackedPlace& place :
             track_places(from->overlap_view(), to->overlap_view(), features)) {
            fields.add(place.b_px, place.miss_px);
            ++count;
        }
        const std::vector<double> of_fields = fields.medians(fewest_places_in_field);
        medians.insert(medians.end(), of_fields.begin(), of_fields.end());
    }
    const double warn_px =
        std::max(place_warn_px, place_warn_share_of_width * std::max(a.left.cols, b.left.cols));
    const double apart_px = root_mean_square(medians);
    return judged(
        {"place", names, apart_px, "px", warn_px, bad_times_warn * warn_px, count},
        medians.empty() ? std::max(count + 1, fewest_places) : fewest_places,
        "too few features that both rigs see to judge their places by",
        fmt::format("rigs {} show one feature {:.1f} px beside where their places put it: one of "
                    "them has been moved or turned; place them again (stage)",
                    names, apart_px));
}

void measure_pair(const std::vector<RigSnapshot>& rigs, int a, int b, StageHealth& health) {
    const RigSnapshot& rig_b = rigs[static_cast<std::size_t>(b)];
    const std::string names = rigs[static_cast<std::size_t>(a)].name + "-" + rig_b.name;
    std::vector<const OverlapSample*> samples;
    double delta_e = 0;
    int coloured = 0;
    for (const OverlapSample& s : health.overlap) {
        if (std::minmax(s.a, s.b) != std::minmax(a, b)) continue;
        // One direction only, since a point too near from here is too far from there.
        if (s.a == a) samples.push_back(&s);
        for (const ColourPair& pair : same_surface({s})) {
            delta_e += delta_e_2000(lab_from_coded(pair.a_coded), lab_from_coded(pair.b_coded));
            ++coloured;
        }
    }
    health.measures.push_back(measure_depth(names, rig_b.left.size(), samples));
    health.measures.push_back(measure_through(rigs, a, b, health.overlap));
    health.measures.push_back(measure_place(rigs[static_cast<std::size_t>(a)], rig_b, names));
    const double apart = coloured > 0 ? delta_e / coloured : 0;
    health.measures.push_back(
        judged({"colour", names, apart, "CIEDE2000", colour_warn, colour_bad, coloured},
               fewest_overlap, "the two rigs agree on too few surfaces to compare colours",
               fmt::format("rigs {} show one surface in colours {:.1f} CIEDE2000 apart: fix "
                           "exposure and white balance, then match them (colour)",
                           names, apart)));
}

constexpr std::string_view pair_measures[] = {"depth", "through", "place", "colour"};

/// Rigs that no chain of pairs with a known `what` connects to the first rig.
std::vector<std::string> not_tied_to_first(const StageHealth& health, std::string_view what) {
    std::vector<std::string> tied{health.rig_names.front()},
        rest(health.rig_names.begin() + 1, health.rig_names.end());
    for (std::size_t next = 0; next < tied.size(); ++next)
        for (const HealthMeasure& m : health.measures) {
            if (m.what != what || m.verdict == Verdict::unknown) continue;
            const auto other = std::find_if(rest.begin(), rest.end(), [&](const std::string& rig) {
                return m.rigs == tied[next] + "-" + rig || m.rigs == rig + "-" + tied[next];
            });
            if (other == rest.end()) continue;
            tied.push_back(*other);
            rest.erase(other);
        }
    return rest;
}

}  // namespace

std::string_view verdict_name(Verdict verdict) {
    switch (verdict) {
        case Verdict::good:
            return "good";
        case Verdict::warn:
            return "warn";
        case Verdict::bad:
            return "bad";
        case Verdict::unknown:
            break;
    }
    return "unknown";
}

Verdict StageHealth::verdict() const {
    Verdict worst = Verdict::good;
    for (const HealthMeasure& m : measures)
        if (m.verdict != Verdict::unknown) worst = std::max(worst, m.verdict);
    return worst == Verdict::good && !not_known().empty() ? Verdict::unknown : worst;
}

std::vector<std::string> StageHealth::not_known() const {
    std::vector<std::string> sentences;
    for (const HealthMeasure& m : measures)
        if (m.what == "rows" && m.verdict == Verdict::unknown) sentences.push_back(m.sentence);
    for (const std::string_view what : pair_measures) {
        const std::vector<std::string> alone = not_tied_to_first(*this, what);
        if (!alone.empty())
            sentences.push_back(fmt::format("{}: nothing ties {} to {}", what,
                                            fmt::join(alone, ", "), rig_names.front()));
    }
    return sentences;
}

std::vector<std::string> StageHealth::sentences_of(Verdict verdict) const {
    std::vector<std::string> sentences;
    for (const HealthMeasure& m : measures)
        if (m.verdict == verdict) sentences.push_back(m.sentence);
    return sentences;
}

StageHealth check_stage(const std::vector<RigSnapshot>& rigs) {
    StageHealth health;
    std::vector<OverlapView> views;
    for (const RigSnapshot& rig : rigs) {
        health.rig_names.push_back(rig.name);
        health.rows.push_back(track_rows(to_grey(rig.left), to_grey(rig.right), features));
        health.measures.push_back(measure_rows(rig, health.rows.back()));
        views.push_back(rig.overlap_view());
    }
    health.overlap = overlap_samples(views, overlap_places);
    for (int a = 0; a < static_cast<int>(rigs.size()); ++a)
        for (int b = a + 1; b < static_cast<int>(rigs.size()); ++b)
            measure_pair(rigs, a, b, health);
    return health;
}

}  // namespace vantage
