#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "calib_tools/health/rig_snapshot.h"
#include "calib_tools/health/row_tracking.h"

namespace vantage {

enum class Verdict { good, warn, bad, unknown };
std::string_view verdict_name(Verdict verdict);

/// One number about a rig, or about two that see one surface, and what it is worth.
struct HealthMeasure {
    std::string what;  ///< "rows", "depth", "place", "colour"
    std::string rigs;  ///< "A", or "A-B"
    double value = 0;
    std::string unit;
    double warn_at = 0, bad_at = 0;  ///< from these values on
    int samples = 0;
    Verdict verdict = Verdict::unknown;
    std::string sentence = {};  ///< what it means and what to do, where it is not good
};

struct StageHealth {
    std::vector<HealthMeasure> measures;
    std::vector<std::string> rig_names;
    std::vector<std::vector<TrackedRow>> rows;  ///< of every rig
    std::vector<OverlapSample> overlap;
    /// The worst of all measures; but good only where enough is known for it: the rows of every
    /// rig, and each measure of two rigs for so many pairs that they tie all rigs together.
    Verdict verdict() const;
    /// A sentence for each thing that is not known enough; none where the stage can be judged.
    std::vector<std::string> not_known() const;
    /// What the measures of this verdict say.
    std::vector<std::string> sentences_of(Verdict verdict) const;
};

/// Without any board: rows (RMS, px, of features tracked from the left to the right picture, the
/// worst tenth left out), depth (RMS over the fields of the picture of the median difference
/// between two rigs' depths of one surface, % of the depth), place (the same of the distances
/// of features from their epipolar lines, px) and colour (mean CIEDE2000 of one
/// surface in two rigs).
StageHealth check_stage(const std::vector<RigSnapshot>& rigs);

}  // namespace vantage
