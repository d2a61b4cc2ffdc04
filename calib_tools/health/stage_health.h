#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "calib_tools/health/rig_snapshot.h"
#include "calib_tools/health/row_tracking.h"

namespace vantage {

enum class Verdict { good, warn, bad, unknown };
std::string_view verdict_name(Verdict verdict);

/// One measure of a rig, or of two rigs that see one surface, with its verdict.
struct HealthMeasure {
    std::string what;  ///< "rows", "depth", "place", "colour"
    std::string rigs;  ///< "A", or "A-B"
    double value = 0;
    std::string unit;
    double warn_at = 0, bad_at = 0;  ///< limits: from these values on
    int samples = 0;
    Verdict verdict = Verdict::unknown;
    std::string sentence = {};  ///< meaning and advice if it is not good
};

struct StageHealth {
    std::vector<HealthMeasure> measures;
    std::vector<std::string> rig_names;
    std::vector<std::vector<TrackedRow>> rows;  ///< of every rig
    std::vector<OverlapSample> overlap;
    /// Worst verdict of all measures. The result is good only if enough is known: the rows of every
    /// rig, and each measure of two rigs for enough pairs to connect all rigs.
    Verdict verdict() const;
    /// One sentence for everything that is not known well enough; empty if the stage can be judged.
    std::vector<std::string> not_known() const;
    /// Sentences of the measures with this verdict.
    std::vector<std::string> sentences_of(Verdict verdict) const;
};

/// Measures the health of a stage without a board.
/// - rows: vertical offset of features between left and right image (RMS in px without the worst
///   tenth)
/// - depth: median difference of two rigs' depths of one surface (RMS over the fields of the
///   image, % of the depth)
/// - place: the same for the distances of features from their epipolar lines (px)
/// - colour: mean CIEDE2000 of one surface in two rigs
StageHealth check_stage(const std::vector<RigSnapshot>& rigs);

}  // namespace vantage
