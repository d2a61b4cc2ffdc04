#include "calib_tools/report/calibration_text.h"

#include <chrono>
#include <cmath>

#include <fmt/chrono.h>

#include "common/base/counted.h"

namespace vantage {
namespace {

std::string camera_lines(const char* name, const CameraModel& m,
                         const BundleUncertainty::Camera& sigma) {
    std::string text = fmt::format(
        "{}: fx {:.2f} +- {:.2f}, fy {:.2f} +- {:.2f}, cx {:.2f} +- {:.2f}, cy {:.2f} +- {:.2f} "
        "px\n"
        "  distortion",
        name, m.fx_px, sigma.fx_px, m.fy_px, sigma.fy_px, m.cx_px, sigma.cx_px, m.cy_px,
        sigma.cy_px);
    for (std::size_t i = 0; i < m.distortion.size(); ++i)
        text += sigma.distortion[i] > 0
                    ? fmt::format(" {:.5f} +- {:.5f}", m.distortion[i], sigma.distortion[i])
                    : fmt::format(" {:g}", m.distortion[i]);
    return text + "\n";
}

template <class Calibration>
std::string closing_lines(const Calibration& c) {
    std::string text = fmt::format("lens family {}", c.bundle.cameras.front().family->name);
    for (const LensTrial& trial : c.trials)
        if (trial.family == c.bundle.cameras.front().family)
            text += fmt::format(" ({:.3f} px on withheld views)", trial.held_out_rms_px);
    text += "\n";
    if (c.corners_left_out > 0)
        text += counted(c.corners_left_out, "corner") + " beyond six sigma left out\n";
    for (const Refusal& refusal : c.rejected)
        text += fmt::format("not used: {} {}\n", refusal.name, refusal.reason);
    for (const std::string& sentence : c.doubts) text += "doubtful: " + sentence + "\n";
    for (const std::string& sentence : c.advice) text += "would help: " + sentence + "\n";
    return text;
}

/// An angle to the hundredth of a degree, never as "-0.00".
double rounded_deg(double angle_deg) { return std::round(100 * angle_deg) / 100 + 0.0; }

/// How the cameras are aimed, and the distances that the disparities reach.
std::string aim_lines(const RigCalibration& c) {
    const RectifiedStereo& r = c.calibration.rectified;
    const double toe_in_deg = rounded_deg(c.aim.toe_in_deg);
    std::string text = fmt::format("aim: toed in by {:.2f} degrees", toe_in_deg);
    if (toe_in_deg < 0) text = fmt::format("aim: turned apart by {:.2f} degrees", -toe_in_deg);
    if (c.aim.crossing_m > 0 && c.aim.crossing_m < 100)
        text += fmt::format(", axes cross at {:.2f} m", c.aim.crossing_m);
    text += fmt::format(", rolled by {:.2f} degrees\nreach:", rounded_deg(c.aim.roll_deg));
    for (const int disparities : reported_disparities)
        text += fmt::format(" from {:.2f} m with {} disparities,", nearest_m(r, disparities),
                            disparities);
    const double far_m = farthest_m(r);
    return text + (std::isfinite(far_m) ? fmt::format(" up to {:.2f} m\n", far_m)
                                        : std::string(" up to infinity\n"));
}

}  // namespace

std::string describe(const CameraCalibration& c) {
    return fmt::format("reprojection {:.3f} px RMS, {} of {} pictures used\n", c.bundle.rms_px(),
                       c.views_used, c.views_given) +
           camera_lines("camera", c.bundle.cameras.front().model, c.uncertainty.cameras.front()) +
           closing_lines(c);
}

std::string describe(const RigCalibration& c) {
    return fmt::format(
               "reprojection {:.3f} px RMS, rows after rectification {:.3f} px RMS (largest "
               "{:.2f}), {} of {} pairs used\nbaseline {:.5f} +- {:.5f} m\n",
               c.bundle.rms_px(), c.row_rms_px, c.row_max_px, c.views_used, c.views_given,
               c.baseline_m, c.baseline_sigma_m) +
           camera_lines("left", c.calibration.left, c.uncertainty.cameras[0]) +
           camera_lines("right", c.calibration.right, c.uncertainty.cameras[1]) + aim_lines(c) +
           closing_lines(c);
}

std::string date_now() {
    const auto now =
        std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
    return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", now);
}

IntrinsicsRecord record_of_foreign_lens(const CameraModel& camera, const std::string& tool) {
    return {.date = date_now(),
            .tool = tool,
            .sigma = {.distortion = std::vector<double>(camera.distortion.size())}};
}

}  // namespace vantage
