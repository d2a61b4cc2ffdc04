#include "rig_firmware/stereo/pass_table.h"

#include <fmt/format.h>

#include "rig_firmware/stereo/pi_model.h"

namespace vantage {
namespace {

std::string row(const PassReport& pass) {
    return fmt::format("{:<22}{:>6}{:>10.2f}{:>10.1f}{:>10.1f}\n", pass.name, pass.runs,
                       pass.gpu_ms, static_cast<double>(pass.bytes_moved) * 1e-6,
                       pass.operations * 1e-6);
}

}  // namespace

std::string pass_table(const Matcher& matcher) {
    std::string table =
        fmt::format("{:<22}{:>6}{:>10}{:>10}{:>10}\n", "pass", "runs", "ms", "MB moved", "M ops");
    PassReport total{.name = "total"};
    for (const PassReport& pass : matcher.passes()) {
        table += row(pass);
        total.runs += pass.runs;
        total.gpu_ms += pass.gpu_ms;
        total.bytes_moved += pass.bytes_moved;
        total.operations += pass.operations;
    }
    table += row(total);
    table += fmt::format("GL objects {:.1f} MB, of which cost volumes {:.1f} MB\n",
                         static_cast<double>(matcher.gpu_bytes()) * 1e-6,
                         static_cast<double>(matcher.cost_volume_bytes()) * 1e-6);
    return table + pi_model_lines(matcher.passes());
}

}  // namespace vantage
