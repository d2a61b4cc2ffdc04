#include "calib_tools/report/calibration_page.h"

#include <algorithm>

#include <fmt/format.h>

#include "calib_tools/report/calibration_text.h"
#include "calib_tools/rig/guidance.h"
#include "common/board/median.h"

namespace vantage {
namespace {

// The limits of the documentation: a good fit is a fraction of a pixel, row errors are a tenth.
constexpr double good_rms_px = 0.3, warn_rms_px = 0.8;

using Row = std::vector<HtmlPage::Cell>;

Row parameter(const std::string& camera, const char* name, double value, double sigma,
              const char* unit) {
    return {{camera},
            {name},
            {fmt::format("{:.6g}", value)},
            {sigma > 0 ? fmt::format("± {:.2g}", sigma) : "held"},
            {unit}};
}

void add_parameters(std::vector<Row>& rows, const std::string& name, const CameraModel& m,
                    const BundleUncertainty::Camera& sigma) {
    rows.push_back(parameter(name, "fx", m.fx_px, sigma.fx_px, "px"));
    rows.push_back(parameter(name, "fy", m.fy_px, sigma.fy_px, "px"));
    rows.push_back(parameter(name, "cx", m.cx_px, sigma.cx_px, "px"));
    rows.push_back(parameter(name, "cy", m.cy_px, sigma.cy_px, "px"));
    static constexpr const char* pinhole[] = {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
    static constexpr const char* fisheye[] = {"k1", "k2", "k3", "k4"};
    for (std::size_t i = 0; i < m.distortion.size(); ++i)
        if (m.distortion[i] != 0 || sigma.distortion[i] > 0)
            rows.push_back(parameter(name, m.lens == LensModel::fisheye ? fisheye[i] : pinhole[i],
                                     m.distortion[i], sigma.distortion[i], ""));
}

void add_camera(HtmlPage& page, const Bundle& bundle, int camera, const std::string& name,
                const std::vector<std::string>& view_names) {
    const CameraModel& m = bundle.cameras[static_cast<std::size_t>(camera)].model;
    page.heading("The " + name + " camera");
    page.figure(draw_vectors(m.width_px, m.height_px, reprojection_vectors(bundle, camera)),
                "Reprojection: from where a corner was seen towards where the model puts it. "
                "Arrows that agree over a whole region mean a lens model that does not fit.");
    const Coverage coverage = measure_coverage(bundle, camera);
    std::vector<int> counts;
    for (const auto& row : coverage.corners_in_cell)
        counts.insert(counts.end(), std::begin(row), std::end(row));
    page.figure(
        draw_coverage(m.width_px, m.height_px, Coverage::columns, Coverage::rows, counts),
        fmt::format("Corners in each part of the picture ({:.0f} % of it seen); boards {:.2f} to "
                    "{:.2f} m away, tilted up to {:.0f} degrees about the upright and {:.0f} about "
                    "the level axis.",
                    100 * coverage.covered_share, coverage.nearest_m, coverage.farthest_m,
                    std::max(coverage.tilt_left_deg, coverage.tilt_right_deg),
                    std::max(coverage.tilt_up_deg, coverage.tilt_down_deg)));
    std::vector<Bar> bars;
    std::vector<double> values;
    for (const BundleView& view : bundle.views)
        if (view.camera == camera) {
            values.push_back(bundle.view_rms_px(view));
            bars.push_back({view_names[static_cast<std::size_t>(view.board)], values.back()});
        }
    page.figure(draw_bars(bars, "px RMS", median(values)),
                "Residual of every view; dashed: the usual one.");
}

void add_doubts(HtmlPage& page, const std::vector<std::string>& doubts) {
    if (doubts.empty()) return;
    page.heading("Doubtful");
    page.list(doubts);
}

template <class Calibration>
void add_closing(HtmlPage& page, const Calibration& c, const std::vector<Row>& parameters) {
    page.heading("Parameters");
    page.table({"camera", "parameter", "value", "1 sigma", "unit"}, parameters);
    page.heading("Choice of the lens family");
    std::vector<Row> trials;
    for (const LensTrial& trial : c.trials) {
        const bool chosen = trial.family == c.bundle.cameras.front().family;
        trials.push_back({{std::string(trial.family->name), chosen ? "good" : ""},
                          {trial.excluded.empty()
                               ? fmt::format("{:.4f} px on withheld views", trial.held_out_rms_px)
                               : "out: " + trial.excluded},
                          {chosen ? "chosen" : ""}});
    }
    page.table({"family", "result", ""}, trials);
    add_refusals(page, c.rejected, c.advice);
}

}  // namespace

std::vector<PictureVector> reprojection_vectors(const Bundle& bundle, int camera) {
    std::vector<PictureVector> vectors;
    for (const BundleView& view : bundle.views)
        if (view.camera == camera)
            for (const BoardCorner& corner : view.corners)
                vectors.push_back({corner.pixel, bundle.residual_px(view, corner)});
    return vectors;
}

void add_refusals(HtmlPage& page, const std::vector<Refusal>& rejected,
                  const std::vector<std::string>& advice) {
    if (!rejected.empty()) {
        page.heading("Not used");
        std::vector<Row> rows;
        for (const Refusal& refusal : rejected) rows.push_back({{refusal.name}, {refusal.reason}});
        page.table({"picture", "reason"}, rows);
    }
    if (!advice.empty()) {
        page.heading("What would help");
        page.list(advice);
    }
}

HtmlPage calibration_page(const CameraCalibration& c) {
    HtmlPage page("Calibration of a camera");
    page.paragraph(date_now());
    const double rms = c.bundle.rms_px();
    page.table({"", "", "good below", "bad from"},
               {{{"reprojection, px RMS"},
                 {fmt::format("{:.3f}", rms), mark_of(rms, good_rms_px, warn_rms_px)},
                 {fmt::format("{:g}", good_rms_px)},
                 {fmt::format("{:g}", warn_rms_px)}},
                {{"pictures used"}, {fmt::format("{} of {}", c.views_used, c.views_given)}}});
    add_doubts(page, c.doubts);
    add_camera(page, c.bundle, 0, "calibrated", c.names);
    std::vector<Row> rows;
    add_parameters(rows, "", c.bundle.cameras[0].model, c.uncertainty.cameras[0]);
    add_closing(page, c, rows);
    return page;
}

HtmlPage calibration_page(const RigCalibration& c) {
    constexpr double good_row_px = 0.2, warn_row_px = 0.5;
    HtmlPage page("Calibration of a rig");
    page.paragraph(date_now());
    const double rms = c.bundle.rms_px();
    page.table(
        {"", "", "good below", "bad from"},
        {{{"reprojection, px RMS"},
          {fmt::format("{:.3f}", rms), mark_of(rms, good_rms_px, warn_rms_px)},
          {fmt::format("{:g}", good_rms_px)},
          {fmt::format("{:g}", warn_rms_px)}},
         {{"rows after rectification, px RMS"},
          {fmt::format("{:.3f}", c.row_rms_px), mark_of(c.row_rms_px, good_row_px, warn_row_px)},
          {fmt::format("{:g}", good_row_px)},
          {fmt::format("{:g}", warn_row_px)}},
         {{"baseline, m"}, {fmt::format("{:.5f} ± {:.5f}", c.baseline_m, c.baseline_sigma_m)}},
         {{"pairs used"}, {fmt::format("{} of {}", c.views_used, c.views_given)}}});
    add_doubts(page, c.doubts);
    add_camera(page, c.bundle, 0, "left", c.names);
    add_camera(page, c.bundle, 1, "right", c.names);
    std::vector<Row> rows;
    add_parameters(rows, "left", c.calibration.left, c.uncertainty.cameras[0]);
    add_parameters(rows, "right", c.calibration.right, c.uncertainty.cameras[1]);
    const Pose& pose = c.calibration.right_from_left;
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(pose.linear()));
    static constexpr const char* turns[] = {"rotation x", "rotation y", "rotation z"};
    static constexpr const char* ways[] = {"translation x", "translation y", "translation z"};
    for (int i = 0; i < 3; ++i)
        rows.push_back(parameter("right from left", turns[i], turn.angle() * turn.axis()[i],
                                 c.uncertainty.cameras[1].rotation_rad[i], "rad"));
    for (int i = 0; i < 3; ++i)
        rows.push_back(parameter("right from left", ways[i], pose.translation()[i],
                                 c.uncertainty.cameras[1].translation_m[i], "m"));
    add_closing(page, c, rows);
    return page;
}

}  // namespace vantage
