#pragma once

#include "calib_tools/plots/html_page.h"
#include "calib_tools/stage/stage_calibration.h"

namespace vantage {

/// Result as a page: the stage from above, every rig's pose with its uncertainty, connections,
/// reprojection errors and residual per frame set.
HtmlPage stage_page(const StageCalibration& stage);

}  // namespace vantage
