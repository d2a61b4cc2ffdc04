#pragma once

#include "calib_tools/plots/html_page.h"
#include "calib_tools/stage/stage_calibration.h"

namespace vantage {

/// The result as a page: the stage from above, every rig's place with its uncertainty, ties,
/// reprojection vectors and residual per instant.
HtmlPage stage_page(const StageCalibration& stage);

}  // namespace vantage
