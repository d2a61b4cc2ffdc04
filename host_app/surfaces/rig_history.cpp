#include "host_app/surfaces/rig_history.h"

#include <algorithm>

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
    matches_ = 0;
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
    ++matches_;
    match_.emplace(Match{texture(TextureFormat::r32f, depth_m),
                         texture(TextureFormat::r32f, learnt_m),
                         texture(TextureFormat::rgba8, colour)});
}

Eigen::Matrix3d RigHistory::K_depth() const {
    return scaled_intrinsics(camera_.K,
                             static_cast<double>(depth().width_px()) / colour_->width_px(),
                             static_cast<double>(depth().height_px()) / colour_->height_px());
}

std::vector<RigHistory*> RigRoster::upload(std::span<const DepthView> views, double dt_s) {
    const float step = static_cast<float>(std::min(dt_s / fade_s, 1.0));
    const auto known = [this](const DepthView& view) {
        return std::find_if(rigs_.begin(), rigs_.end(),
                            [&](const auto& rig) { return rig->camera().name == view.name; });
    };
    const bool is_same_stage =
        views.empty() || std::any_of(views.begin(), views.end(), [&](const DepthView& view) {
            return known(view) != rigs_.end();
        });
    if (!is_same_stage) rigs_.clear();
    const bool is_first = rigs_.empty();
    std::vector<RigHistory*> uploaded;
    for (const DepthView& view : views) {
        if (!view.has_depth() || view.colour.empty()) continue;
        if (const auto found = known(view); found != rigs_.end()) {
            uploaded.push_back(found->get());
            uploaded.back()->set_presence(std::min(1.0f, uploaded.back()->presence() + step));
        } else {
            uploaded.push_back(rigs_.emplace_back(std::make_unique<RigHistory>()).get());
            uploaded.back()->set_presence(is_first ? 1.0f : step);
        }
        uploaded.back()->upload(view, dt_s);
    }
    shown_ = uploaded;
    for (const auto& rig : rigs_) {
        if (std::find(uploaded.begin(), uploaded.end(), rig.get()) != uploaded.end()) continue;
        rig->set_presence(rig->presence() - step);
        if (rig->presence() > 0.5f * step && rig->surface()) {
            shown_.push_back(rig.get());
        } else {
            rig->set_presence(0);
            rig->hide();
        }
    }
    return uploaded;
}

void RigRoster::cut() {
    for (const auto& rig : rigs_) rig->hide();
}

void RigRoster::forget() {
    for (const auto& rig : rigs_) rig->forget();
}

bool RigRoster::keep_only(const std::set<std::string>& names) {
    return std::erase_if(rigs_, [&](const auto& rig) {
               return !names.contains(rig->camera().name) &&
                      std::find(shown_.begin(), shown_.end(), rig.get()) == shown_.end();
           }) > 0;
}

std::vector<RigHistory*> RigRoster::known() const {
    std::vector<RigHistory*> all;
    for (const auto& rig : rigs_) all.push_back(rig.get());
    return all;
}

bool RigRoster::has_learnt(const RigHistory* rig) const {
    return std::any_of(rigs_.begin(), rigs_.end(), [&](const auto& one) {
        return one.get() == rig && one->learnt_instants() > 0;
    });
}

}  // namespace vantage
