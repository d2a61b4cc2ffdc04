#include "calib_tools/health/stage_health.h"

#include <algorithm>
#include <cmath>

#include "calib_tools/board/median.h"
#include "calib_tools/colour/cielab.h"
#include "common/base/error.h"
#include "common/image/image_file.h"

namespace vantage {
namespace {

constexpr int features = 400, overlap_places = 3000;
constexpr int fewest_rows = 20, fewest_overlap = 50;
// Matching costs start to rise from 0.3 px on; beyond 1 px whole surfaces are lost.
constexpr double row_warn_px = 0.3, row_bad_px = 0.8;
// A matcher errs by several tenths of a pixel here and there, but not over whole fields at once.
constexpr double depth_warn_share = 0.01, matcher_bias_px = 0.3, bad_times_warn = 3;
constexpr double colour_warn = 2.0, colour_bad = 5.0;
// Farther apart than this two depths are of two surfaces.
constexpr double same_surface_share = 0.15;
constexpr int fields_a_side = 4, fewest_in_field = 8;

/// The measure with its verdict: unknown for fewer samples than `fewest`, with the sentence
/// `too_few`; where it is not good, with the sentence `not_good`.
HealthMeasure judged(HealthMeasure m, int fewest, std::string_view too_few, std::string not_good) {
    if (m.samples < fewest) {
        m.verdict = Verdict::unknown;
        m.sentence = fmt::format("{} ({} places, {} are needed)", too_few, m.samples, fewest);
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
    for (const TrackedRow& row : rows) misses.push_back(std::abs(row.row_miss_px));
    std::sort(misses.begin(), misses.end());
    misses.resize(misses.size() - misses.size() / 10);
    double squares = 0;
    for (const double miss : misses) squares += miss * miss;
    const double rms_px =
        misses.empty() ? 0 : std::sqrt(squares / static_cast<double>(misses.size()));
    return judged(
        {"rows", rig.name, rms_px, "px", row_warn_px, row_bad_px, static_cast<int>(rows.size())},
        fewest_rows, "too few features to follow from the left to the right picture",
        fmt::format("the rows of rig {} miss each other by {:.2f} px: a camera or lens has moved "
                    "on its rig; calibrate it again (stereo)",
                    rig.name, rms_px));
}

/// Depth differences of two rigs by fields of the picture: noise of the matcher has no side it
/// prefers, a rig that was moved has, though not the same one in every field.
HealthMeasure measure_depth(const std::string& names, const cv::Size& size,
                            const std::vector<const OverlapSample*>& samples) {
    std::vector<double> fields[fields_a_side][fields_a_side], bias_shares;
    int count = 0;
    for (const OverlapSample* s : samples) {
        const double share = (s->measured_m - s->predicted_m) / s->predicted_m;
        if (std::abs(share) > same_surface_share) continue;
        ++count;
        const int column = std::clamp(static_cast<int>(s->b_px.x() * fields_a_side / size.width), 0,
                                      fields_a_side - 1);
        const int row = std::clamp(static_cast<int>(s->b_px.y() * fields_a_side / size.height), 0,
                                   fields_a_side - 1);
        fields[row][column].push_back(share);
        // What a third of a pixel of disparity makes of this place's depth.
        if (s->disparity_miss != 0)
            bias_shares.push_back(std::abs(share / s->disparity_miss) * matcher_bias_px);
    }
    double squares = 0;
    int used = 0;
    for (const auto& row : fields)
        for (const std::vector<double>& field : row) {
            if (static_cast<int>(field.size()) < fewest_in_field) continue;
            squares += std::pow(median(field), 2);
            ++used;
        }
    const double warn_percent = 100 * std::max(depth_warn_share, median(bias_shares));
    const double apart_percent = used > 0 ? 100 * std::sqrt(squares / used) : 0;
    return judged({"depth", names, apart_percent, "% of depth", warn_percent,
                   bad_times_warn * warn_percent, count},
                  fewest_overlap, "the two rigs see too little of the same surfaces",
                  fmt::format("rigs {} see one surface {:.1f} % of its depth apart: one of them "
                              "has been moved; place them again (stage)",
                              names, apart_percent));
}

void measure_pair(const std::vector<RigSnapshot>& rigs, int a, int b, StageHealth& health) {
    const RigSnapshot& rig_b = rigs[static_cast<std::size_t>(b)];
    const std::string names = rigs[static_cast<std::size_t>(a)].name + "-" + rig_b.name;
    std::vector<const OverlapSample*> samples;
    double delta_e = 0;
    int coloured = 0;
    for (const OverlapSample& s : health.overlap) {
        if (std::minmax(s.a, s.b) != std::minmax(a, b)) continue;
        // One way only: what is too near from here is too far from there.
        if (s.a == a) samples.push_back(&s);
        for (const ColourPair& pair : same_surface({s})) {
            delta_e += delta_e_2000(lab_from_coded(pair.a_coded), lab_from_coded(pair.b_coded));
            ++coloured;
        }
    }
    health.measures.push_back(measure_depth(names, rig_b.left.size(), samples));
    const double apart = coloured > 0 ? delta_e / coloured : 0;
    health.measures.push_back(
        judged({"colour", names, apart, "CIEDE2000", colour_warn, colour_bad, coloured},
               fewest_overlap, "the two rigs agree on too few surfaces to compare colours",
               fmt::format("rigs {} show one surface in colours {:.1f} CIEDE2000 apart: fix "
                           "exposure and white balance, then match them (colour)",
                           names, apart)));
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

Verdict StageHealth::worst() const {
    Verdict worst = Verdict::unknown;
    for (const HealthMeasure& m : measures) {
        if (m.verdict == Verdict::unknown) continue;
        if (worst == Verdict::unknown || m.verdict > worst) worst = m.verdict;
    }
    return worst;
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
