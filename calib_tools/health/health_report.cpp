#include "calib_tools/health/health_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "calib_tools/plots/drawings.h"
#include "common/base/counted.h"

namespace vantage {
namespace {

std::string number(const HealthMeasure& m) {
    return m.verdict == Verdict::unknown ? "-" : fmt::format("{:.2f}", m.value);
}

std::string_view mark_of(Verdict verdict) {
    return verdict == Verdict::unknown ? "" : verdict_name(verdict);
}

std::string drawing(const StageHealth& health, const std::vector<RigSnapshot>& rigs) {
    std::vector<PlacedRig> placed;
    for (const RigSnapshot& rig : rigs) {
        const RectifiedStereo& r = rig.calibration.rectified;
        placed.push_back({rig.name, rig.calibration.world_from_rectified_left(),
                          2 * std::atan(0.5 * r.width_px / r.f_px), 0});
    }
    std::vector<RigTie> ties;
    for (std::size_t a = 0; a < rigs.size(); ++a)
        for (std::size_t b = a + 1; b < rigs.size(); ++b)
            for (const HealthMeasure& m : health.measures)
                if (m.what == "depth" && m.rigs == rigs[a].name + "-" + rigs[b].name &&
                    m.verdict != Verdict::unknown)
                    ties.push_back(
                        {a, b, fmt::format("{:.1f} %", m.value), m.verdict != Verdict::good});
    return draw_stage(placed, ties, true);
}

}  // namespace

nlohmann::json to_json(const StageHealth& health, const std::string& date) {
    nlohmann::json measures = nlohmann::json::array();
    for (const HealthMeasure& m : health.measures) {
        nlohmann::json entry = {{"what", m.what},       {"rigs", m.rigs},
                                {"unit", m.unit},       {"verdict", verdict_name(m.verdict)},
                                {"warn_at", m.warn_at}, {"bad_at", m.bad_at},
                                {"samples", m.samples}};
        if (m.verdict != Verdict::unknown) entry["value"] = m.value;
        if (!m.sentence.empty()) entry["sentence"] = m.sentence;
        measures.push_back(entry);
    }
    return {{"date", date},
            {"verdict", verdict_name(health.verdict())},
            {"not_known", health.not_known()},
            {"rigs", health.rig_names},
            {"measures", measures}};
}

std::string describe(const StageHealth& health) {
    std::string text = fmt::format("the stage is {}\n", verdict_name(health.verdict()));
    for (const HealthMeasure& m : health.measures)
        text += fmt::format(
            "{:7} {:7} {:>8} {:14} {:7} ({} places; warn from {:.2f}, bad from {:.2f})\n", m.what,
            m.rigs, number(m), m.unit, verdict_name(m.verdict), m.samples, m.warn_at, m.bad_at);
    for (const HealthMeasure& m : health.measures)
        if (!m.sentence.empty()) text += m.sentence + "\n";
    return text;
}

HtmlPage health_page(const StageHealth& health, const std::vector<RigSnapshot>& rigs,
                     const std::vector<PastCheck>& past, const std::string& date) {
    HtmlPage page("Health of the stage");
    page.paragraph(date);
    page.paragraph(fmt::format("The stage is {}.", verdict_name(health.verdict())),
                   mark_of(health.verdict()));
    if (const std::vector<std::string> not_known = health.not_known(); !not_known.empty()) {
        page.heading("Not known");
        page.list(not_known);
    }
    std::vector<std::vector<HtmlPage::Cell>> rows;
    std::vector<std::string> sentences;
    for (const HealthMeasure& m : health.measures) {
        rows.push_back({{m.what},
                        {m.rigs},
                        {number(m), mark_of(m.verdict)},
                        {m.unit},
                        {std::string(verdict_name(m.verdict)), mark_of(m.verdict)},
                        {fmt::format("{:.2f}", m.warn_at)},
                        {fmt::format("{:.2f}", m.bad_at)},
                        {std::to_string(m.samples)}});
        if (!m.sentence.empty()) sentences.push_back(m.sentence);
    }
    page.table({"measure", "rigs", "value", "unit", "verdict", "warn from", "bad from", "places"},
               rows);
    if (!sentences.empty()) {
        page.heading("What to do");
        page.list(sentences);
    }
    page.heading("The stage from above");
    page.figure(
        drawing(health, rigs),
        "Lines: depth agreement of two rigs that see the same surfaces (dashed: not good).");
    page.heading("Rows after rectification");
    for (std::size_t i = 0; i < rigs.size(); ++i) {
        std::vector<PictureVector> vectors;
        for (const TrackedRow& row : health.rows[i])
            vectors.push_back({row.left_px, {0, row.row_miss_px}});
        page.figure(draw_vectors(rigs[i].left.cols, rigs[i].left.rows, vectors),
                    fmt::format("Rig {}, calibrated {}: how far the right picture shows a feature "
                                "below its row of the left one.",
                                rigs[i].name, rigs[i].calibration_date));
    }
    if (!past.empty()) {
        page.heading("History of " + counted(past.size() + 1, "check"));
        for (const HealthMeasure& m : health.measures) {
            if (m.verdict == Verdict::unknown) continue;
            std::vector<double> values = values_of(past, m);
            values.push_back(m.value);
            page.figure(draw_history(values, m.warn_at, m.bad_at, m.unit),
                        fmt::format("{} {}, {}", m.what, m.rigs, m.unit));
        }
    }
    return page;
}

}  // namespace vantage
