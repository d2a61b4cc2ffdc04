#pragma once

#include "calib_tools/plots/drawings.h"
#include "calib_tools/plots/html_page.h"
#include "calib_tools/rig/rig_calibration.h"

namespace vantage {

/// The result as a page: quality first, then reprojection vectors, coverage and residual per view
/// of every camera, parameters with uncertainties, what was refused and what would help.
HtmlPage calibration_page(const CameraCalibration& calibration);
HtmlPage calibration_page(const RigCalibration& calibration);

/// Reprojection misses of one camera of a bundle.
std::vector<PictureVector> reprojection_vectors(const Bundle& bundle, int camera);

/// Columns and cells of what was refused, and what would help, as every page shows them.
void add_refusals(HtmlPage& page, const std::vector<Refusal>& rejected,
                  const std::vector<std::string>& advice);

}  // namespace vantage
