#include "calib_tools/rig/doubts.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "calib_tools/rig/camera_solver.h"
#include "common/base/counted.h"
#include "common/base/error.h"

namespace vantage {
namespace {

// A flat board in good light gives 0.05 to 0.3 px at any resolution.
constexpr double usual_rms_px = 0.5, usual_rms_share_of_width = 0.0007;
constexpr double together_times = 3, together_plus_px = 0.15;
constexpr double overfit_times = 2, overfit_plus_px = 0.1;
constexpr double sure_focal_share = 0.01;
constexpr double square_pixel_share = 0.02, equal_lenses_share = 0.1, centre_share = 0.15;
constexpr std::size_t few_views = 6;

double apart(double a, double b) { return std::abs(a - b) / std::min(a, b); }

void doubt_fit(const Bundle& bundle, const DoubtEvidence& evidence,
               std::vector<std::string>& doubts) {
    const double rms = bundle.rms_px();
    const double limit =
        std::max(usual_rms_px, usual_rms_share_of_width * bundle.cameras.front().model.width_px);
    const std::string together = doubt_together(robust_sigma_px(bundle), evidence.alone_sigma_px);
    if (!together.empty())
        doubts.push_back(together);
    else if (rms > limit)
        doubts.push_back(
            fmt::format("the corners miss the model by {:.2f} px RMS, more than {:.2f} px: the "
                        "board is bent, or moved while a picture was taken; glue it to something "
                        "flat, and hold it still",
                        rms, limit));
    if (evidence.held_out_rms_px > overfit_times * rms &&
        evidence.held_out_rms_px > rms + overfit_plus_px)
        doubts.push_back(
            fmt::format("withheld views miss by {:.2f} px where those used miss by {:.2f} px: the "
                        "pictures are too few or too alike to determine the lens; add some",
                        evidence.held_out_rms_px, rms));
}

void doubt_lens(const CameraModel& m, const BundleUncertainty::Camera& sigma,
                const std::string& name, std::vector<std::string>& doubts) {
    const double focal_share = std::max(sigma.fx_px / m.fx_px, sigma.fy_px / m.fy_px);
    if (focal_share > sure_focal_share)
        doubts.push_back(
            fmt::format("the focal length of the {} camera is uncertain by {:.1f} %, more than "
                        "{:.0f} %: add pictures of the board tilted by 30 degrees, near and far",
                        name, 100 * focal_share, 100 * sure_focal_share));
    if (apart(m.fx_px, m.fy_px) >
        std::max(square_pixel_share, 3 * std::hypot(sigma.fx_px, sigma.fy_px) / m.fx_px))
        doubts.push_back(
            fmt::format("the pixels of the {} camera are {:.3f} times as wide as high: if its "
                        "sensor has square ones the pictures were scaled, and the rig must deliver "
                        "them scaled alike",
                        name, m.fy_px / m.fx_px));
    const double off_x = std::abs(m.cx_px - 0.5 * (m.width_px - 1)) / m.width_px;
    const double off_y = std::abs(m.cy_px - 0.5 * (m.height_px - 1)) / m.height_px;
    if (std::max(off_x, off_y) > centre_share)
        doubts.push_back(fmt::format(
            "the principal point of the {} camera, ({:.0f}, {:.0f}), is far from the middle of "
            "its {}x{} pictures: if they were not cut out of larger ones, add pictures of tilted "
            "boards",
            name, m.cx_px, m.cy_px, m.width_px, m.height_px));
}

}  // namespace

std::string doubt_together(double together_sigma_px, double alone_sigma_px) {
    if (alone_sigma_px <= 0 || together_sigma_px < together_times * alone_sigma_px ||
        together_sigma_px < alone_sigma_px + together_plus_px)
        return {};
    return fmt::format(
        "the corners miss by {:.2f} px with both cameras together and by {:.2f} px with each "
        "alone: the two pictures of a pair are not of one instant, or the cameras move on the "
        "rig; trigger both together, or hold the board still",
        together_sigma_px, alone_sigma_px);
}

std::vector<std::string> doubts_of(const Bundle& bundle, const BundleUncertainty& uncertainty,
                                   const DoubtEvidence& evidence) {
    std::vector<std::string> doubts;
    doubt_fit(bundle, evidence, doubts);
    for (std::size_t i = 0; i < bundle.cameras.size(); ++i)
        doubt_lens(bundle.cameras[i].model, uncertainty.cameras[i], evidence.camera_names[i],
                   doubts);
    if (bundle.cameras.size() == 2) {
        const CameraModel &left = bundle.cameras[0].model, &right = bundle.cameras[1].model;
        if (apart(left.fx_px, right.fx_px) > equal_lenses_share)
            doubts.push_back(
                fmt::format("the focal lengths of the two cameras, {:.0f} and {:.0f} px, differ by "
                            "{:.0f} %: a rig wants two equal lenses, or what is seen through the "
                            "shorter one lacks detail",
                            left.fx_px, right.fx_px, 100 * apart(left.fx_px, right.fx_px)));
    }
    std::set<int> boards;
    for (const BundleView& view : bundle.views) boards.insert(view.board);
    if (boards.size() < few_views)
        doubts.push_back(
            fmt::format("it rests on {}, too few to notice one that misleads: 10 are good",
                        counted(boards.size(), "view")));
    return doubts;
}

}  // namespace vantage
