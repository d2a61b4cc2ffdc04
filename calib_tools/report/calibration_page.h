#pragma once

#include "calib_tools/plots/drawings.h"
#include "calib_tools/plots/html_page.h"
#include "calib_tools/rig/rig_calibration.h"

namespace vantage {

/// Result as a page: quality first; then reprojection errors, coverage and residual per view of
/// every camera; parameters with uncertainties; refused images and advice.
HtmlPage calibration_page(const CameraCalibration& calibration);
HtmlPage calibration_page(const RigCalibration& calibration);

/// Reprojection errors of one camera of a bundle.
std::vector<PictureVector> reprojection_vectors(const Bundle& bundle, int camera);

/// Adds the refused images and the advice, which all pages show in the same way.
void add_refusals(HtmlPage& page, const std::vector<Refusal>& rejected,
                  const std::vector<std::string>& advice);

}  // namespace vantage
