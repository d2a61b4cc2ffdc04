#include "rig_firmware/stereo/pi_model.h"

#include <algorithm>

#include <fmt/format.h>

namespace vantage {

double modelled_frame_ms(const PiModel& model, const std::vector<PassReport>& passes) {
    double seconds = 0;
    for (const PassReport& pass : passes)
        seconds += std::max(static_cast<double>(pass.bytes_moved) / model.traffic_bytes_per_s,
                            pass.operations / model.operations_per_s);
    return seconds * 1e3;
}

std::string pi_model_lines(const std::vector<PassReport>& passes) {
    std::string lines;
    for (const PiModel& model : pi_models)
        lines += fmt::format(
            "{}: a frame takes {:.1f} ms at least, by a model of bandwidth and instructions (not "
            "measured)\n",
            model.name, modelled_frame_ms(model, passes));
    return lines;
}

}  // namespace vantage
