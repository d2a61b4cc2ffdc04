#include "host_app/background/background_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "common/wire/codec/right_picture.h"
#include "host_app/views/depth_view.h"
#include "host_app/views/projection.h"

namespace vantage {
namespace {

/// Lengths of the temporal means of depth and colour: long enough for the noise, short enough to
/// follow a lamp that is dimmed.
constexpr double depth_mean_s = 6, colour_mean_s = 3;
/// Time after which a different depth is accepted where the colour stays.
constexpr double patience_s = 1;
/// Distance of matte pixels from pixels that do not show the background, at most: the reach of
/// matte.frag and of the filters after it.
constexpr float matte_reach_px = 6;
/// Time after which foreground that stands still becomes background.
constexpr double absorbed_after_s = 120;
/// Time without change after which a pixel's background is known; a shorter pause may be part of a
/// movement.
constexpr double known_after_s = 0.5;
/// Instants in the longest means; certainties are shares of them.
constexpr int max_depth_mean = 128, max_colour_mean = 32;
/// Width of the picture that look_at() reads back, px.
constexpr int max_sampled_px = 128;

float max_colour_instants(double dt_s) {
    return instants_of(colour_mean_s, dt_s, 4, max_colour_mean);
}

/// Instants without change after which a pixel's background is known.
float known_after_of(double dt_s) { return instants_of(known_after_s, dt_s, 3, 30); }

}  // namespace

float instants_of(double seconds, double dt_s, int min, int max) {
    const double instants = dt_s > 0 ? std::round(seconds / dt_s) : max;
    return static_cast<float>(
        std::clamp(instants, static_cast<double>(min), static_cast<double>(max)));
}

void BackgroundModel::learn(RigHistory& rig) {
    // Before the inputs, since making a texture binds it.
    BackgroundState& background = rig.background_to_learn();
    const cv::Size picture = rig.fresh_colour().size();
    const Eigen::Vector2f size(static_cast<float>(picture.width),
                               static_cast<float>(picture.height));
    rig.matte().resize(picture);
    rig.matte_tiles().resize(TilePass::tiles_of(picture));
    hard_.resize(picture);
    const bool has_before = background.is_drawn() && rig.has_colour_before();
    const Framebuffer& colour = rig.next_colour_target();
    const Texture& background_colour = has_before ? rig.colour_mean() : rig.fresh_colour();
    const Texture& state_before = has_before ? background.state() : rig.depth();
    const auto set_depth_mean = [&](Program& program) {
        program.set("spread", depth_spread(rig.camera()));
        program.set("has_before", has_before ? 1.0f : 0.0f);
    };

    TwoStagePass& comparing = rig.depth().size() == picture ? compare_same_size_ : compare_;
    comparing.draw(background.seen_target(), [&](Program& compare) {
        compare.input("depth_map", rig.depth());
        compare.input("picture", rig.fresh_colour());
        compare.input("background_colour", background_colour);
        set_background_now(compare, rig, state_before);
        set_depth_mean(compare);
    });

    Program& tiles = tiles_.use();
    tiles.input("seen", background.seen());
    tiles.set("tile_share", TilePass::share_of(picture));
    tiles.set("margin_share", Eigen::Vector2f(matte_reach_px * size.cwiseInverse()));
    tiles_.draw(rig.matte_tiles().target());

    Program& matte = matte_.use();
    matte.input("picture", rig.fresh_colour());
    matte.input("seen", background.seen());
    matte_.draw(hard_.target(), rig.matte_tiles().texture(), picture);

    Program& edges = edges_.use();
    edges.input("hard", hard_.texture());
    edges.input("picture", rig.fresh_colour());
    edges.input("background_colour", background_colour);
    edges_.draw(rig.matte().target(), rig.matte_tiles().texture(), picture);

    Program& learn = learn_.use();
    learn.input("depth_map", rig.depth());
    learn.input("background_before", state_before);
    learn.input("seen", background.seen());
    learn.input("matte", rig.matte().texture());
    set_depth_mean(learn);
    learn.set("most_instants", max_instants(rig));
    learn.set("most_misses", instants_of(patience_s, rig.dt_s(), 3, 30));
    learn.set("absorbed_after", static_cast<float>(absorbed_after_s / std::max(rig.dt_s(), 1e-3)));
    learn_.draw(background.next_target());

    Program& show = colour_.use();
    show.input("picture", rig.fresh_colour());
    show.input("before", background_colour);
    show.input("shown_before", has_before ? rig.denoised_colour() : rig.fresh_colour());
    show.input("seen", background.seen());
    show.input("matte", rig.matte().texture());
    show.set("has_before", has_before ? 1.0f : 0.0f);
    show.set("most_instants", max_colour_instants(rig.dt_s()));
    colour_.draw(colour);
    rig.finish_background();
    rig.finish_colour();
}

void BackgroundModel::set_background_now(Program& program, const RigHistory& rig,
                                         const Texture& state) {
    const std::optional<RigHistory::Model>& model = rig.model();
    program.input("model", model ? model->surface->depth() : state);
    program.input("background_state", state);
    // The count of a pixel is limited: one at the limit has not changed since an older model
    // either.
    program.set("since", model ? std::min(static_cast<float>(rig.learnt_instants() - model->made),
                                          max_instants(rig) - 1)
                               : 0.0f);
}

void BackgroundModel::set_model_then(Program& program, const RigHistory& rig) {
    const std::optional<RigHistory::Model>& model = rig.model();
    const Texture& state = rig.background_state().state();
    program.input("depth_then", model ? model->learnt_m->texture() : state);
    program.input("colour_then", model ? model->colour->texture() : rig.colour_mean());
    program.input("background_colour", rig.colour_mean());
    program.set("spread", depth_spread(rig.camera()));
}

float BackgroundModel::max_instants(const RigHistory& rig) {
    return instants_of(depth_mean_s, rig.dt_s(), 8, max_depth_mean);
}

float BackgroundModel::known_after(const RigHistory& rig) { return known_after_of(rig.dt_s()); }

RigBackground BackgroundModel::learnt(const RigHistory& rig) {
    RigBackground background;
    background.rig = rig.camera().name;
    background.calibration =
        calibration_of(rig.camera(), rig.fresh_colour().size(), rig.depth().size());
    const cv::Mat state = rig.background_state().state().download();
    cv::extractChannel(state, background.depth_m, 0);
    cv::Mat counts, mean;
    cv::extractChannel(state, counts, 1);
    counts.convertTo(background.certainty, CV_8U, 255 / max_instants(rig));
    rig.colour_mean().download().convertTo(mean, CV_32F);
    std::vector<cv::Mat> channels;
    cv::split(mean, channels);
    channels[3] /= max_colour_instants(rig.dt_s());
    cv::merge(channels, mean);
    mean.convertTo(background.colour, CV_8U, 255);
    return background;
}

void BackgroundModel::restore(RigHistory& rig, const RigBackground& background) {
    cv::Mat counts;
    background.certainty.convertTo(counts, CV_32F, max_depth_mean / 255.0);
    cv::Mat whole(counts.size(), CV_32F);
    // The fraction of the count would be misses.
    for (int y = 0; y < counts.rows; ++y)
        for (int x = 0; x < counts.cols; ++x)
            whole.at<float>(y, x) = std::max(1.0f, std::floor(counts.at<float>(y, x)));
    const cv::Mat none = cv::Mat::zeros(counts.size(), CV_32F);
    cv::Mat4f state;
    cv::merge(std::vector<cv::Mat>{background.depth_m, whole, none, none}, state);
    cv::Mat mean;
    background.colour.convertTo(mean, CV_32F, 1 / 255.0);
    std::vector<cv::Mat> channels;
    cv::split(mean, channels);
    channels[3] *= max_colour_mean;
    cv::merge(channels, mean);
    cv::Mat halves;
    mean.convertTo(halves, CV_16F);
    rig.restore(state, halves, max_depth_mean);
}

cv::Mat1b BackgroundModel::known(const RigBackground& background, double dt_s) {
    // The first instant adds nothing to the mean's alpha.
    const double least = 255 * (known_after_of(dt_s) - 1) / max_colour_instants(dt_s);
    cv::Mat1b still;
    cv::extractChannel(background.colour, still, 3);
    cv::resize(still, still, background.depth_m.size(), 0, 0, cv::INTER_NEAREST);
    return (still >= std::floor(least)) & (background.depth_m > 0);
}

BackgroundView BackgroundModel::picture(const RigHistory& rig) {
    const RigBackground background = learnt(rig);
    const cv::Size whole = background.depth_m.size();
    const cv::Size size = background_match_size(whole);
    BackgroundView picture;
    picture.K = scaled_intrinsics(rig.K_depth(), static_cast<double>(size.width) / whole.width,
                                  static_cast<double>(size.height) / whole.height);
    picture.world_from_camera = rig.camera().world_from_camera;
    picture.baseline_m = rig.camera().baseline_m;
    picture.right_jpegs.assign(rig.right_jpegs().begin(), rig.right_jpegs().end());
    picture.right_px = background_match_size(rig.fresh_colour().size());
    picture.right_correction = rig.camera().colour_correction;
    picture.doffs_px = rig.camera().doffs_px * size.width / rig.fresh_colour().width_px();
    cv::resize(background.depth_m, picture.depth_m, size, 0, 0, cv::INTER_NEAREST_EXACT);
    cv::resize(background.colour, picture.colour, size, 0, 0, cv::INTER_AREA);
    cv::Mat known;
    cv::resize(BackgroundModel::known(background, rig.dt_s()), known, size, 0, 0,
               cv::INTER_NEAREST_EXACT);
    cv::insertChannel(known, picture.colour, 3);
    return picture;
}

BackgroundModel::Look BackgroundModel::look_at(const RigHistory& rig) {
    const cv::Size picture = rig.matte().size();
    const double reduction = std::max(1.0, picture.width / static_cast<double>(max_sampled_px));
    const cv::Size sampled(std::max(1, cvRound(picture.width / reduction)),
                           std::max(1, cvRound(picture.height / reduction)));
    sampled_.resize(sampled);
    Program& known = known_.use();
    known.input("background_state", rig.background_state().state());
    set_model_then(known, rig);
    known.set("known_after", known_after(rig));
    known.input("matte", rig.matte());
    known.set("sample_share", Eigen::Vector2f(1.0f / static_cast<float>(sampled.width),
                                              1.0f / static_cast<float>(sampled.height)));
    known_.draw(sampled_.target());
    std::array<cv::Mat1b, 4> seen;
    cv::split(sampled_.texture().download(), seen.data());
    const double samples = sampled.area();
    return {cv::countNonZero(seen[0]) / samples, cv::countNonZero(seen[2]) / samples, seen[1]};
}

}  // namespace vantage
