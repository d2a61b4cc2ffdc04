#include "calib_tools/report/calibration_json.h"

#include <cmath>
#include <string>

#include "calib_tools/rig/guidance.h"

namespace vantage {
namespace {

using nlohmann::json;

json camera_json(const CameraModel& m, const BundleUncertainty::Camera& sigma) {
    return {{"width_px", m.width_px},
            {"height_px", m.height_px},
            {"lens", m.lens == LensModel::fisheye ? "fisheye" : "pinhole"},
            {"fx", m.fx_px},
            {"fy", m.fy_px},
            {"cx", m.cx_px},
            {"cy", m.cy_px},
            {"distortion", m.distortion},
            {"sigma",
             {{"fx", sigma.fx_px},
              {"fy", sigma.fy_px},
              {"cx", sigma.cx_px},
              {"cy", sigma.cy_px},
              {"distortion", sigma.distortion}}}};
}

json trials_json(const std::vector<LensTrial>& trials) {
    json list = json::array();
    for (const LensTrial& trial : trials) {
        json entry = {{"family", std::string(trial.family->name)}};
        if (trial.excluded.empty())
            entry["held_out_rms_px"] = trial.held_out_rms_px;
        else
            entry["excluded"] = trial.excluded;
        list.push_back(entry);
    }
    return list;
}

json rejected_json(const std::vector<Refusal>& rejected) {
    json list = json::array();
    for (const Refusal& refusal : rejected)
        list.push_back({{"name", refusal.name}, {"reason", refusal.reason}});
    return list;
}

json coverage_json(const Bundle& bundle, int camera) {
    const Coverage c = measure_coverage(bundle, camera);
    return {{"covered_share", c.covered_share},   {"tilt_left_deg", c.tilt_left_deg},
            {"tilt_right_deg", c.tilt_right_deg}, {"tilt_up_deg", c.tilt_up_deg},
            {"tilt_down_deg", c.tilt_down_deg},   {"nearest_m", c.nearest_m},
            {"farthest_m", c.farthest_m}};
}

json views_json(const Bundle& bundle, const std::vector<std::string>& names,
                const std::vector<std::string>& cameras) {
    json list = json::array();
    for (const BundleView& view : bundle.views)
        list.push_back({{"name", names[static_cast<std::size_t>(view.board)]},
                        {"camera", cameras[static_cast<std::size_t>(view.camera)]},
                        {"corners", view.corners.size()},
                        {"rms_px", bundle.view_rms_px(view)}});
    return list;
}

template <class Calibration>
json common_json(const Calibration& c, const std::vector<std::string>& cameras) {
    return {{"rms_px", c.bundle.rms_px()},
            {"corner_sigma_px", c.uncertainty.residual_sigma_px},
            {"views_given", c.views_given},
            {"views_used", c.views_used},
            {"corners_left_out", c.corners_left_out},
            {"rejected", rejected_json(c.rejected)},
            {"inverted", c.printed.inverted},
            {"legacy", c.printed.legacy},
            {"lens_family", std::string(c.bundle.cameras.front().family->name)},
            {"lens_trials", trials_json(c.trials)},
            {"views", views_json(c.bundle, c.names, cameras)},
            {"doubts", c.doubts},
            {"advice", c.advice}};
}

}  // namespace

json to_json(const CameraCalibration& c) {
    json result = common_json(c, {"camera"});
    result["camera"] = camera_json(c.bundle.cameras.front().model, c.uncertainty.cameras.front());
    result["coverage"] = coverage_json(c.bundle, 0);
    // The numbers that scripts need most are repeated at the top level.
    for (const char* key : {"fx", "fy", "cx", "cy"}) result[key] = result["camera"][key];
    return result;
}

json to_json(const RigCalibration& c) {
    json result = common_json(c, {"left", "right"});
    result["row_rms_px"] = c.row_rms_px;
    result["row_max_px"] = c.row_max_px;
    result["baseline_m"] = c.baseline_m;
    result["baseline_sigma_m"] = c.baseline_sigma_m;
    result["left"] = camera_json(c.calibration.left, c.uncertainty.cameras[0]);
    result["right"] = camera_json(c.calibration.right, c.uncertainty.cameras[1]);
    result["left"]["coverage"] = coverage_json(c.bundle, 0);
    result["right"]["coverage"] = coverage_json(c.bundle, 1);
    const Pose& pose = c.calibration.right_from_left;
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(pose.linear()));
    const Eigen::Vector3d rotation = turn.angle() * turn.axis();
    const auto list = [](const Eigen::Vector3d& v) { return json{v.x(), v.y(), v.z()}; };
    result["right_from_left"] = {
        {"rotation_rad", list(rotation)},
        {"translation_m", list(pose.translation())},
        {"sigma",
         {{"rotation_rad", list(c.uncertainty.cameras[1].rotation_rad)},
          {"translation_m", list(c.uncertainty.cameras[1].translation_m)}}}};
    const RectifiedStereo& r = c.calibration.rectified;
    result["rectified"] = {
        {"width_px", r.width_px},     {"height_px", r.height_px},     {"f_px", r.f_px},
        {"cx_left_px", r.cx_left_px}, {"cx_right_px", r.cx_right_px}, {"cy_px", r.cy_px},
        {"baseline_m", r.baseline_m}};
    result["aim"] = {{"toe_in_deg", c.aim.toe_in_deg},
                     {"roll_deg", c.aim.roll_deg},
                     {"crossing_m", c.aim.crossing_m > 0 ? json(c.aim.crossing_m) : json()}};
    const double far_m = farthest_m(r);
    result["far_m"] = std::isfinite(far_m) ? json(far_m) : json();
    for (const int disparities : reported_disparities)
        result["nearest_m"][std::to_string(disparities)] = nearest_m(r, disparities);
    return result;
}

}  // namespace vantage
