#include "calib_tools/rig/lens_choice.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/base/error.h"
#include "common/base/log.h"

namespace vantage {
namespace {

constexpr int fold_count = 5;
constexpr double good_enough = 1.01;

/// Solves the same views with another family, starting from the solution of a related one.
std::optional<Bundle> solve_from(const Bundle& start, const LensFamily& family) {
    Bundle bundle = start;
    BundleCamera& camera = bundle.cameras.front();
    camera.family = &family;
    camera.model.distortion.resize(static_cast<std::size_t>(family.stored_coefficients), 0.0);
    for (std::size_t k = 0; k < camera.model.distortion.size(); ++k)
        if (!family.free[k]) camera.model.distortion[k] = 0;
    if (!solve_robustly(bundle)) return std::nullopt;
    return bundle;
}

struct HeldOut {
    double squares = 0;
    std::size_t corners = 0;
};

/// Withholds every fold in turn. Empty if one of the calibrations fails.
std::optional<HeldOut> hold_out(const Bundle& solved) {
    HeldOut sum;
    const int folds = std::min<int>(fold_count, static_cast<int>(solved.views.size()));
    for (int fold = 0; fold < folds; ++fold) {
        Bundle kept = solved, withheld = solved;
        kept.views.clear();
        withheld.views.clear();
        for (std::size_t i = 0; i < solved.views.size(); ++i)
            (static_cast<int>(i) % folds == fold ? withheld : kept)
                .views.push_back(solved.views[i]);
        if (!solve_robustly(kept)) return std::nullopt;
        withheld.cameras.front().model = kept.cameras.front().model;
        withheld.cameras.front().solve_lens = false;
        // An outlying view must not decide, so that large residuals count linearly.
        if (!solve_robustly(withheld)) return std::nullopt;
        const double limit = 5 * std::max(0.01, robust_sigma_px(withheld));
        for (const BundleView& view : withheld.views)
            for (const BoardCorner& corner : view.corners) {
                const double r = std::min(limit, withheld.residual_px(view, corner).norm());
                sum.squares += r * r;
                ++sum.corners;
            }
    }
    return sum;
}

struct Attempt {
    LensTrial trial;
    std::vector<Bundle> cameras;
};

Attempt attempt_family(const std::vector<CameraViews>& cameras, const LensFamily& family,
                       const std::vector<std::optional<Bundle>>& starts) {
    Attempt attempt;
    attempt.trial.family = &family;
    HeldOut total;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        const bool related = starts[i] && starts[i]->cameras.front().model.lens == family.lens;
        const std::optional<Bundle> solved =
            related ? solve_from(*starts[i], family) : solve_camera(cameras[i], family);
        if (!solved) {
            attempt.trial.excluded = "it diverges";
            return attempt;
        }
        const std::string fault = implausibility(solved->cameras.front().model);
        if (!fault.empty()) {
            attempt.trial.excluded = "it leads to " + fault;
            return attempt;
        }
        const std::optional<HeldOut> held_out = hold_out(*solved);
        if (!held_out) {
            attempt.trial.excluded = "it diverges with fewer views";
            return attempt;
        }
        total.squares += held_out->squares;
        total.corners += held_out->corners;
        attempt.cameras.push_back(*solved);
    }
    attempt.trial.held_out_rms_px =
        std::sqrt(total.squares / std::max(1.0, static_cast<double>(total.corners)));
    return attempt;
}

}  // namespace

LensChoice use_lens(const std::vector<CameraViews>& cameras, const LensFamily& family) {
    const Attempt attempt =
        attempt_family(cameras, family, std::vector<std::optional<Bundle>>(cameras.size()));
    if (!attempt.trial.excluded.empty())
        fail(
            "lens family '{}' cannot be used with these pictures: {}; take pictures of the board "
            "tilted in several directions",
            family.name, attempt.trial.excluded);
    return {&family, {attempt.trial}, attempt.cameras};
}

LensChoice choose_lens(const std::vector<CameraViews>& cameras) {
    std::size_t fewest_views = cameras.front().instants.size();
    std::vector<std::optional<Bundle>> starts;
    for (const CameraViews& views : cameras) {
        fewest_views = std::min<std::size_t>(
            fewest_views, static_cast<std::size_t>(std::count_if(
                              views.instants.begin(), views.instants.end(),
                              [](const BoardCorners& corners) { return !corners.empty(); })));
        starts.push_back(solve_camera(views, lens_family("radial1")));
    }
    std::vector<Attempt> attempts;
    for (const LensFamily& family : lens_families()) {
        if (fewest_views < fold_count && family.free_count() > 2) continue;
        attempts.push_back(attempt_family(cameras, family, starts));
        const LensTrial& trial = attempts.back().trial;
        if (trial.excluded.empty())
            log_info("lens family {}: {:.3f} px on withheld views", family.name,
                     trial.held_out_rms_px);
        else
            log_info("lens family {} is out: {}", family.name, trial.excluded);
    }
    double best = 0;
    for (const Attempt& attempt : attempts)
        if (attempt.trial.excluded.empty() && (best == 0 || attempt.trial.held_out_rms_px < best))
            best = attempt.trial.held_out_rms_px;
    LensChoice choice;
    const Attempt* chosen = nullptr;
    for (const Attempt& attempt : attempts) {
        choice.trials.push_back(attempt.trial);
        if (!attempt.trial.excluded.empty() || attempt.trial.held_out_rms_px > good_enough * best)
            continue;
        if (!chosen || attempt.trial.family->free_count() < chosen->trial.family->free_count())
            chosen = &attempt;
    }
    if (!chosen)
        fail(
            "no lens model fits these pictures (the mildest: {}): check that the board is flat and "
            "its size right, and take pictures of it tilted in several directions",
            attempts.front().trial.excluded);
    choice.family = chosen->trial.family;
    choice.cameras = chosen->cameras;
    return choice;
}

}  // namespace vantage
