#pragma once

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "calib_tools/stage/stage_calibration.h"
#include "tests/support/boards/rendered_stage.h"

namespace vantage {

/// By how much the rigs of a rendered stage are placed wrong, against the first rig, as the
/// uncertainties are stated; root mean square over the other rigs.
struct PlaceErrors {
    double rms_mm = 0, rms_deg = 0;
    double z_rms = 0;  ///< misses over stated uncertainties
};

inline PlaceErrors place_errors(const StageCalibration& solved, const RenderedStage& stage) {
    constexpr double degrees = 180 / std::numbers::pi;
    constexpr int others = RenderedStage::rig_count - 1;
    PlaceErrors errors;
    for (int r = 1; r <= others; ++r) {
        const StageCalibration::Rig& rig = solved.rigs[static_cast<std::size_t>(r)];
        const Pose found =
            solved.rigs[0].calibration.world_from_left.inverse() * rig.calibration.world_from_left;
        const Pose truth =
            stage.truth(0).world_from_left.inverse() * stage.truth(r).world_from_left;
        const double miss_m = (found.translation() - truth.translation()).norm();
        const double miss_rad =
            Eigen::AngleAxisd(Eigen::Matrix3d(found.linear().transpose() * truth.linear())).angle();
        errors.rms_mm += 1e6 * miss_m * miss_m / others;
        errors.rms_deg += degrees * degrees * miss_rad * miss_rad / others;
        errors.z_rms += (std::pow(miss_m / rig.translation_sigma_m, 2) +
                         std::pow(miss_rad / rig.rotation_sigma_rad, 2)) /
                        (2 * others);
    }
    return {std::sqrt(errors.rms_mm), std::sqrt(errors.rms_deg), std::sqrt(errors.z_rms)};
}

}  // namespace vantage
