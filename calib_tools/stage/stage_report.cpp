#include "calib_tools/stage/stage_report.h"

#include <algorithm>

#include <fmt/format.h>

#include "common/base/counted.h"
#include "common/geometry/json_rows.h"

namespace vantage {
namespace {

/// A line for each reason, with the names of all pictures that have it: on a wide stage most
/// pictures show the board to some rigs only.
std::string not_used_lines(const std::vector<Refusal>& rejected) {
    std::vector<Refusal> by_reason;
    for (const Refusal& refusal : rejected) {
        const auto same =
            std::find_if(by_reason.begin(), by_reason.end(),
                         [&](const Refusal& other) { return other.reason == refusal.reason; });
        if (same == by_reason.end())
            by_reason.push_back(refusal);
        else
            same->name += ", " + refusal.name;
    }
    std::string lines;
    for (const Refusal& refusal : by_reason)
        lines += fmt::format("not used: {} {}\n", refusal.name, refusal.reason);
    return lines;
}

}  // namespace

nlohmann::json to_json(const StageCalibration& stage) {
    using nlohmann::json;
    json rigs = json::array(), ties = json::array(), rejected = json::array();
    for (const StageCalibration::Rig& rig : stage.rigs) {
        rigs.push_back({{"name", rig.name},
                        {"world_from_left", json_rows(rig.calibration.world_from_left)},
                        {"translation_sigma_m", rig.translation_sigma_m},
                        {"rotation_sigma_deg", rig.rotation_sigma_deg()},
                        {"rms_px", rig.rms_px},
                        {"instants", rig.instants},
                        {"refined", rig.refined},
                        {"focal_change", rig.focal_change},
                        {"baseline_change_m", rig.baseline_change_m}});
    }
    for (const StageCalibration::Tie& tie : stage.ties)
        ties.push_back({{"rigs", {stage.rigs[tie.a].name, stage.rigs[tie.b].name}},
                        {"shared_instants", tie.shared}});
    for (const Refusal& refusal : stage.rejected)
        rejected.push_back({{"name", refusal.name}, {"reason", refusal.reason}});
    json bodies = json::array();
    for (const StageCalibration::Body& body : stage.bodies) {
        json faces = json::array();
        for (std::size_t i = 0; i < body.boards.size(); ++i) {
            json face = {{"board", body.boards[i] + 1}};
            if (!body.body_from_board.empty()) {
                face["body_from_board"] = json_rows(body.body_from_board[i]);
                face["translation_sigma_m"] = body.translation_sigma_m[i];
            }
            faces.push_back(face);
        }
        bodies.push_back({{"name", body.name}, {"boards", faces}});
    }
    json next;
    if (stage.next_picture)
        next = {{"rigs",
                 {stage.rigs[stage.next_picture->a].name, stage.rigs[stage.next_picture->b].name}},
                {"gains_most", stage.rigs[stage.next_picture->rig].name},
                {"translation_sigma_now_m", stage.next_picture->sigma_now_m},
                {"translation_sigma_then_m", stage.next_picture->sigma_then_m}};
    return {{"next_picture", next},
            {"rms_px", stage.rms_px},
            {"instants_given", stage.instants_given},
            {"instants_used", stage.instants_used},
            {"world", stage.has_floor ? "board on the floor"
                                      : "the first rig is taken to stand level at 1.6 m"},
            {"rigs", rigs},
            {"ties", ties},
            {"bodies", bodies},
            {"rejected", rejected},
            {"advice", stage.advice}};
}

std::string next_picture_sentence(const StageCalibration& stage) {
    if (!stage.next_picture) return {};
    const NextPicture& next = *stage.next_picture;
    return fmt::format(
        "one more picture helps most where {} and {} both see the board: it would make the place "
        "of {} certain to {:.2f} mm instead of {:.2f} mm",
        stage.rigs[next.a].name, stage.rigs[next.b].name, stage.rigs[next.rig].name,
        1000 * next.sigma_then_m, 1000 * next.sigma_now_m);
}

std::string describe(const StageCalibration& stage) {
    std::string text =
        fmt::format("reprojection {:.3f} px RMS, {} of {} instants used; world: {}\n", stage.rms_px,
                    stage.instants_used, stage.instants_given,
                    stage.has_floor ? "board on the floor, y up"
                                    : "the first rig is taken to stand level at 1.6 m");
    for (const StageCalibration::Rig& rig : stage.rigs) {
        const Eigen::Vector3d at = rig.calibration.world_from_left.translation();
        text += fmt::format(
            "{}: at ({:.4f}, {:.4f}, {:.4f}) m, +- {:.2f} mm, +- {:.4f} degrees, {:.3f} px RMS, "
            "{}\n",
            rig.name, at.x(), at.y(), at.z(), 1000 * rig.translation_sigma_m,
            rig.rotation_sigma_deg(), rig.rms_px,
            counted(static_cast<std::size_t>(rig.instants), "instant"));
        if (rig.refined)
            text += fmt::format("   lenses refined by {:.3f} %, baseline by {:.2f} mm\n",
                                100 * rig.focal_change, 1000 * rig.baseline_change_m);
    }
    for (const StageCalibration::Body& body : stage.bodies)
        if (body.boards.size() > 1)
            text += fmt::format("{}: {} boards fixed to each other, placed to {:.2f} mm\n",
                                body.name, body.boards.size(),
                                1000 * *std::max_element(body.translation_sigma_m.begin(),
                                                         body.translation_sigma_m.end()));
    text += not_used_lines(stage.rejected);
    for (const std::string& sentence : stage.advice) text += "would help: " + sentence + "\n";
    if (const std::string next = next_picture_sentence(stage); !next.empty()) text += next + "\n";
    return text;
}

}  // namespace vantage
