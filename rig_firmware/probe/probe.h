#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace vantage {

/// Result of one probe of this computer. Probes never throw for missing, forbidden or broken
/// devices: they report them.
struct ProbePart {
    std::string title;
    nlohmann::json facts;            ///< machine-readable findings
    std::vector<std::string> lines;  ///< the same findings as text
    std::vector<std::string>
        unfit;  ///< sentences: what a rig on this computer would lack, and the mend
};

ProbePart probe_libcamera();  ///< cameras by id, with their modes
ProbePart probe_v4l2();       ///< video nodes, with formats, sizes, rates and controls
ProbePart probe_gpio();       ///< chips and lines, with the holder of each line
/// Ways to a context, renderer, limits, import of camera buffers, and the presets that fit.
/// `measures`: times the presets on a GPU that no model describes, which takes some seconds.
ProbePart probe_gpu(bool measures);
ProbePart probe_clocks();        ///< TAI, resolutions, PTP devices and daemons, scheduling
ProbePart probe_known_faults();  ///< board, kernel, linuxptp, and their known faults

}  // namespace vantage
