#include "calib_tools/stage/stage_page.h"

#include <cmath>

#include <fmt/format.h>

#include "calib_tools/report/calibration_page.h"
#include "calib_tools/report/calibration_text.h"
#include "calib_tools/stage/stage_report.h"
#include "common/board/median.h"

namespace vantage {
namespace {

std::string drawing(const StageCalibration& stage) {
    std::vector<PlacedRig> rigs;
    for (const StageCalibration::Rig& rig : stage.rigs) {
        const CameraModel& left = rig.calibration.left;
        rigs.push_back({rig.name, rig.calibration.world_from_left,
                        2 * std::atan(0.5 * left.width_px / left.fx_px), rig.translation_sigma_m});
    }
    std::vector<RigTie> ties;
    for (const StageCalibration::Tie& tie : stage.ties)
        if (tie.shared > 0)
            ties.push_back({tie.a, tie.b, std::to_string(tie.shared),
                            tie.shared < StageCalibration::few_shared});
    return draw_stage(rigs, ties, stage.has_floor);
}

}  // namespace

HtmlPage stage_page(const StageCalibration& stage) {
    // 1 mm and 0.02 degrees correspond to one pixel of a rig's image at 4 m.
    constexpr double warn_mm = 1, bad_mm = 4, warn_deg = 0.02, bad_deg = 0.1;
    HtmlPage page("Calibration of a stage");
    page.paragraph(date_now());
    page.paragraph(fmt::format("Reprojection {:.3f} px RMS; {} of {} instants used; world: {}.",
                               stage.rms_px, stage.instants_used, stage.instants_given,
                               stage.has_floor ? "the board on the floor, y up"
                                               : "the first rig is taken to stand level at 1.6 m"));
    page.figure(drawing(stage),
                "The stage from above. Lines: instants that two rigs saw together (dashed: too "
                "few). Discs: uncertainty, a hundred times enlarged.");
    std::vector<std::vector<HtmlPage::Cell>> rows;
    for (const StageCalibration::Rig& rig : stage.rigs) {
        const Eigen::Vector3d at = rig.calibration.world_from_left.translation();
        const double mm = 1000 * rig.translation_sigma_m, deg = rig.rotation_sigma_deg();
        rows.push_back({{rig.name},
                        {fmt::format("{:.4f}, {:.4f}, {:.4f}", at.x(), at.y(), at.z())},
                        {fmt::format("{:.2f}", mm), mark_of(mm, warn_mm, bad_mm)},
                        {fmt::format("{:.4f}", deg), mark_of(deg, warn_deg, bad_deg)},
                        {fmt::format("{:.3f}", rig.rms_px)},
                        {std::to_string(rig.instants)},
                        {rig.refined ? fmt::format("{:.3f} %", 100 * rig.focal_change) : "held"}});
    }
    page.heading("Rigs");
    page.table({"rig", "place x, y, z (m)", "± mm", "± degrees", "px RMS", "instants",
                "focal length refined by"},
               rows);
    std::vector<std::vector<HtmlPage::Cell>> faces;
    for (const StageCalibration::Body& body : stage.bodies)
        for (std::size_t i = 0; i < body.body_from_board.size(); ++i) {
            const Eigen::Vector3d at = body.body_from_board[i].translation();
            faces.push_back({{body.name},
                             {std::to_string(body.boards[i] + 1)},
                             {fmt::format("{:.4f}, {:.4f}, {:.4f}", at.x(), at.y(), at.z())},
                             {fmt::format("{:.2f}", 1000 * body.translation_sigma_m[i])}});
        }
    if (!faces.empty()) {
        page.heading("Boards that are fixed to each other");
        page.table({"body", "board", "place x, y, z (m)", "± mm"}, faces);
    }
    page.heading("Residuals");
    for (std::size_t i = 0; i < stage.bundle.cameras.size(); ++i) {
        const CameraModel& m = stage.bundle.cameras[i].model;
        page.figure(draw_vectors(m.width_px, m.height_px,
                                 reprojection_vectors(stage.bundle, static_cast<int>(i))),
                    fmt::format("Rig {}, {} camera", stage.rigs[i / 2].name,
                                i % 2 == 0 ? "left" : "right"));
    }
    std::vector<Bar> bars;
    std::vector<double> values;
    for (std::size_t b = 0; b < stage.placements.size(); ++b) {
        double squares = 0, corners = 0;
        for (const BundleView& view : stage.bundle.views) {
            if (view.board != static_cast<int>(b)) continue;
            const auto count = static_cast<double>(view.corners.size());
            squares += std::pow(stage.bundle.view_rms_px(view), 2) * count;
            corners += count;
        }
        if (corners == 0) continue;
        values.push_back(std::sqrt(squares / corners));
        bars.push_back({stage.bodies.size() == 1 ? std::to_string(stage.placements[b].instant)
                                                 : stage.placement_name(static_cast<int>(b)),
                        values.back()});
    }
    page.figure(draw_bars(bars, "px RMS", median(values)),
                "Residual of every instant; dashed: the usual one.");
    if (const std::string next = next_picture_sentence(stage); !next.empty())
        page.paragraph(next + ".");
    add_refusals(page, stage.rejected, stage.advice);
    return page;
}

}  // namespace vantage
