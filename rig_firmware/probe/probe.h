#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace vantage {

/// What one look at this computer found. None of them throws for what is missing, forbidden or
/// broken: that is what they report.
struct ProbePart {
    std::string title;
    nlohmann::json facts;            ///< for machines
    std::vector<std::string> lines;  ///< the same for people
    std::vector<std::string> unfit;  ///< sentences: what a rig would miss here, and the mend
};

ProbePart probe_libcamera();  ///< cameras by id, with their modes
ProbePart probe_v4l2();       ///< video nodes, with formats, sizes, rates and controls
ProbePart probe_gpio();       ///< chips and lines, with who holds each
ProbePart probe_gpu();        ///< ways to a context, renderer, limits, import of camera buffers
ProbePart probe_clocks();     ///< TAI, resolutions, PTP devices and daemons, scheduling
ProbePart
probe_known_faults();  ///< board, kernel, linuxptp, and what is known to be wrong with them

}  // namespace vantage
