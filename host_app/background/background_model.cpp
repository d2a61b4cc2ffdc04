#include "host_app/background/background_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "common/wire/codec/right_picture.h"
#include "host_app/views/depth_spread.h"
#include "host_app/views/projection.h"

namespace vantage {
namespace {

constexpr float softness = 0.002f;
/// Of the means of depth and colour.
constexpr double depth_mean_s = 6, colour_mean_s = 3;
/// A depth that jumps where the colour stays is not believed before.
constexpr double patience_s = 1;
/// How far from what is apart from the set a matte may be drawn: matte.frag's reach, and filters.
constexpr float matte_reach_px = 6;
/// What stands still before the set for so long is a part of it.
constexpr double absorbed_after_s = 120;
/// What was still for so long is the set; less may be a moment of what moves.
constexpr double known_after_s = 0.5;
/// The longest means, of which certainties are shares.
constexpr int longest_depth_mean = 128, longest_colour_mean = 32;
/// Pixels across that look_at() looks at.
constexpr int most_sampled_px = 128;

float most_colour_instants(double dt_s) {
    return instants_of(colour_mean_s, dt_s, 4, longest_colour_mean);
}

/// Instants that a pixel has to have been still for before it is known to show the set.
float known_after_of(double dt_s) { return instants_of(known_after_s, dt_s, 3, 30); }

}  // namespace

float instants_of(double seconds, double dt_s, int fewest, int most) {
    const double instants = dt_s > 0 ? std::round(seconds / dt_s) : most;
    return static_cast<float>(
        std::clamp(instants, static_cast<double>(fewest), static_cast<double>(most)));
}

void BackgroundModel::learn(RigHistory& rig) {
    // Asked for before anything is bound: making a texture binds it.
    BackgroundState& set = rig.set_to_learn();
    const cv::Size picture = rig.fresh_colour().size();
    const Eigen::Vector2f size(static_cast<float>(picture.width),
                               static_cast<float>(picture.height));
    rig.matte().resize(picture);
    rig.matte_tiles().resize(TilePass::tiles_of(picture));
    hard_.resize(picture);
    const bool has_before = set.is_drawn() && rig.has_colour_before();
    const Framebuffer& colour = rig.next_colour_target();
    const Texture& background_colour = has_before ? rig.colour_mean() : rig.fresh_colour();
    const Texture& state_before = has_before ? set.state() : rig.depth();
    const auto set_votes = [&](Program& program) {
        program.set("softness", softness);
        program.set("spread", depth_spread(rig.camera()));
        program.set("has_before", has_before ? 1.0f : 0.0f);
    };

    TwoStagePass& seeing = rig.depth().size() == picture ? see_alike_ : see_;
    seeing.draw(set.seen_target(), [&](Program& see) {
        see.input("depth_map", rig.depth());
        see.input("picture", rig.fresh_colour());
        see.input("background_colour", background_colour);
        set_background_now(see, rig, state_before);
        set_votes(see);
    });

    Program& tiles = tiles_.use();
    tiles.input("seen", set.seen());
    tiles.set("tile_share", TilePass::share_of(picture));
    tiles.set("margin_share", Eigen::Vector2f(matte_reach_px * size.cwiseInverse()));
    tiles_.draw(rig.matte_tiles().target());

    Program& matte = matte_.use();
    matte.input("picture", rig.fresh_colour());
    matte.input("seen", set.seen());
    matte_.draw(hard_.target(), rig.matte_tiles().texture(), picture);

    Program& edges = edges_.use();
    edges.input("hard", hard_.texture());
    edges.input("picture", rig.fresh_colour());
    edges.input("background_colour", background_colour);
    edges_.draw(rig.matte().target(), rig.matte_tiles().texture(), picture);

    Program& learn = learn_.use();
    learn.input("depth_map", rig.depth());
    learn.input("background_before", state_before);
    learn.input("seen", set.seen());
    learn.input("matte", rig.matte().texture());
    set_votes(learn);
    learn.set("most_instants", most_votes(rig));
    learn.set("most_misses", instants_of(patience_s, rig.dt_s(), 3, 30));
    learn.set("absorbed_after", static_cast<float>(absorbed_after_s / std::max(rig.dt_s(), 1e-3)));
    learn_.draw(set.next_target());

    Program& show = colour_.use();
    show.input("picture", rig.fresh_colour());
    show.input("before", background_colour);
    show.input("seen", set.seen());
    show.input("matte", rig.matte().texture());
    show.set("has_before", has_before ? 1.0f : 0.0f);
    show.set("most_instants", most_colour_instants(rig.dt_s()));
    colour_.draw(colour);
    rig.finish_set();
    rig.finish_colour();
}

void BackgroundModel::set_background_now(Program& program, const RigHistory& rig,
                                         const Texture& state) {
    const std::optional<RigHistory::Model>& model = rig.model();
    program.input("model", model ? model->surface->depth() : state);
    program.input("background_state", state);
    // What has not changed for as long as is counted has not changed since an older model either.
    program.set("since", model ? std::min(static_cast<float>(rig.learnt_instants() - model->made),
                                          most_votes(rig) - 1)
                               : 0.0f);
}

float BackgroundModel::most_votes(const RigHistory& rig) {
    return instants_of(depth_mean_s, rig.dt_s(), 8, longest_depth_mean);
}

float BackgroundModel::known_after(const RigHistory& rig) { return known_after_of(rig.dt_s()); }

RigBackground BackgroundModel::learnt(const RigHistory& rig) {
    RigBackground set;
    set.rig = rig.camera().name;
    set.calibration = calibration_of(rig.camera(), rig.fresh_colour().size(), rig.depth().size());
    const cv::Mat state = rig.background_state().state().download();
    cv::extractChannel(state, set.depth_m, 0);
    cv::Mat votes, mean;
    cv::extractChannel(state, votes, 1);
    votes.convertTo(set.certainty, CV_8U, 255 / most_votes(rig));
    rig.colour_mean().download().convertTo(mean, CV_32F);
    std::vector<cv::Mat> channels;
    cv::split(mean, channels);
    channels[3] /= most_colour_instants(rig.dt_s());
    cv::merge(channels, mean);
    mean.convertTo(set.colour, CV_8U, 255);
    return set;
}

void BackgroundModel::restore(RigHistory& rig, const RigBackground& set) {
    cv::Mat votes;
    set.certainty.convertTo(votes, CV_32F, longest_depth_mean / 255.0);
    cv::Mat whole(votes.size(), CV_32F);
    // Their fraction would count what did not agree.
    for (int y = 0; y < votes.rows; ++y)
        for (int x = 0; x < votes.cols; ++x)
            whole.at<float>(y, x) = std::max(1.0f, std::floor(votes.at<float>(y, x)));
    const cv::Mat none = cv::Mat::zeros(votes.size(), CV_32F);
    cv::Mat4f state;
    cv::merge(std::vector<cv::Mat>{set.depth_m, whole, none, none}, state);
    cv::Mat mean;
    set.colour.convertTo(mean, CV_32F, 1 / 255.0);
    std::vector<cv::Mat> channels;
    cv::split(mean, channels);
    channels[3] *= longest_colour_mean;
    cv::merge(channels, mean);
    cv::Mat halves;
    mean.convertTo(halves, CV_16F);
    rig.restore(state, halves, longest_depth_mean);
}

cv::Mat1b BackgroundModel::known(const RigBackground& set, double dt_s) {
    // The first instant counts nothing in the mean's alpha.
    const double least = 255 * (known_after_of(dt_s) - 1) / most_colour_instants(dt_s);
    cv::Mat1b still;
    cv::extractChannel(set.colour, still, 3);
    cv::resize(still, still, set.depth_m.size(), 0, 0, cv::INTER_NEAREST);
    return (still >= std::floor(least)) & (set.depth_m > 0);
}

BackgroundView BackgroundModel::picture(const RigHistory& rig) {
    const RigBackground set = learnt(rig);
    const cv::Size whole = set.depth_m.size();
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
    cv::resize(set.depth_m, picture.depth_m, size, 0, 0, cv::INTER_NEAREST_EXACT);
    cv::resize(set.colour, picture.colour, size, 0, 0, cv::INTER_AREA);
    cv::Mat known;
    cv::resize(BackgroundModel::known(set, rig.dt_s()), known, size, 0, 0, cv::INTER_NEAREST_EXACT);
    cv::insertChannel(known, picture.colour, 3);
    return picture;
}

BackgroundModel::Look BackgroundModel::look_at(const RigHistory& rig) {
    const cv::Size picture = rig.matte().size();
    const double reduction = std::max(1.0, picture.width / static_cast<double>(most_sampled_px));
    const cv::Size sampled(std::max(1, cvRound(picture.width / reduction)),
                           std::max(1, cvRound(picture.height / reduction)));
    sampled_.resize(sampled);
    Program& known = known_.use();
    known.input("background_state", rig.background_state().state());
    known.input("background_colour", rig.colour_mean());
    known.set("known_after", known_after(rig));
    known.input("matte", rig.matte());
    known.set("sample_share", Eigen::Vector2f(1.0f / static_cast<float>(sampled.width),
                                              1.0f / static_cast<float>(sampled.height)));
    known_.draw(sampled_.target());
    std::array<cv::Mat1b, 2> seen;
    cv::split(sampled_.texture().download(), seen.data());
    return {cv::countNonZero(seen[0]) / static_cast<double>(sampled.area()), seen[1]};
}

}  // namespace vantage
