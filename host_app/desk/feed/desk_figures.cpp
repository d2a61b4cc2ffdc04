#include "host_app/desk/feed/desk_figures.h"

#include <fmt/format.h>

namespace vantage {

std::vector<DeskFigure> desk_figures(const LiveReport& report) {
    const ProgrammeStats& programme = report.programme;
    if (programme.ticks == 0) return {};
    std::vector<DeskFigure> figures{
        {"ticks, reprojected, repeated, missed",
         fmt::format("{}, {}, {}, {}", programme.ticks, programme.reprojected, programme.repeated,
                     programme.missed)}};
    // How long nearly all took and how long the worst.
    const auto add_ms = [&](const char* name, const Percentiles& ms) {
        if (ms.count > 0)
            figures.push_back({name, fmt::format("{:.0f} ms, 99 % {:.0f}, at worst {:.0f}", ms.p50,
                                                 ms.p99, ms.max)});
    };
    add_ms("between pictures", programme.interval_ms);
    add_ms("exposure to picture", programme.latency_ms);
    add_ms("hand to picture", programme.input_ms);
    add_ms("jump to picture", programme.seek_ms);
    figures.push_back({"instants, skipped", fmt::format("{}, {}", report.instants_prepared,
                                                        report.frame_sets_superseded)});
    figures.push_back({"rendering, by level", shares_text(programme.render_shares)});
    figures.push_back({"preparing, by level", shares_text(programme.prepare_shares)});
    return figures;
}

}  // namespace vantage
