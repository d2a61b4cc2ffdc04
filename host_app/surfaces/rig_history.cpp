#include "host_app/surfaces/rig_history.h"

#include "host_app/views/projection.h"

namespace vantage {
namespace {

/// Right images that are kept: 8 s, in which a passing person hides no place most of the time.
constexpr std::size_t max_right_pictures = 16;

}  // namespace

void RigHistory::forget() {
    denoised_colour_.forget();
    background_.forget();
    learnt_instants_ = 0;
    model_.reset();
    right_jpegs_.clear();
    match_.reset();
    hide();
}

void RigHistory::hide() {
    surface_.reset();
    performers_.reset();
    prepared_rank_.reset();
}

void RigHistory::upload(const DepthView& view, double dt_s) {
    const bool is_same_camera =
        colour_ && colour_->size() == view.colour.size() && depth().size() == view.depth_size() &&
        camera_.K == view.K &&
        camera_.world_from_camera.matrix() == view.world_from_camera.matrix();
    dt_s_ = is_same_camera && !is_background_learnt_ ? dt_s_ + dt_s : dt_s;
    if (!is_same_camera) forget();
    if (!prepared_rank_) hide();
    prepared_rank_.reset();
    picture_now_.reset();
    is_colour_denoised_ = is_background_learnt_ = false;
    if (view.right_jpeg && (right_jpegs_.empty() || right_jpegs_.back() != view.right_jpeg))
        right_jpegs_.push_back(view.right_jpeg);
    if (right_jpegs_.size() > max_right_pictures) right_jpegs_.pop_front();
    camera_ = view;
    camera_.release_pictures();
    if (!colour_ || colour_->size() != view.colour.size())
        colour_.emplace(TextureFormat::rgba8, view.colour.cols, view.colour.rows, Filter::linear);
    upload_colour(view, corrector_, *colour_);
    upload_depth(view, uploader_, depth_);
    samples_ = surface_samples(view);
}

void RigHistory::set_background_match(const DepthImage& depth_m, const DepthImage& learnt_m,
                                      const ColourImage& colour) {
    const auto texture = [](TextureFormat format, const cv::Mat& image) {
        Texture filled(format, image.cols, image.rows);
        filled.upload(image);
        return filled;
    };
    match_.emplace(Match{texture(TextureFormat::r32f, depth_m),
                         texture(TextureFormat::r32f, learnt_m),
                         texture(TextureFormat::rgba8, colour)});
}

Eigen::Matrix3d RigHistory::K_depth() const {
    return scaled_intrinsics(camera_.K,
                             static_cast<double>(depth().width_px()) / colour_->width_px(),
                             static_cast<double>(depth().height_px()) / colour_->height_px());
}

}  // namespace vantage
