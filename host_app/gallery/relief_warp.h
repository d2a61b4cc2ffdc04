#pragma once

#include <optional>

#include "common/gl/objects/program.h"
#include "host_app/surfaces/rig_surface.h"
#include "host_app/views/depth_view.h"

namespace vantage {

/// The pre-warp of relief texture mapping (Oliveira, Bishop, McAllister, "Relief texture mapping",
/// 2000): a picture with depth becomes, in two passes along rows and columns, what is seen of it
/// from the virtual camera's place on a plane before the rig; mapping that onto the plane as any
/// texture gives the view, parallax and all.
class ReliefWarp {
  public:
    /// The relief is larger than the picture by this share of it at every side, as far as a texture
    /// may be, since points before and behind the plane move across its border.
    static constexpr double margin_share = 0.25;

    explicit ReliefWarp(const ShaderLibrary& library);

    /// Warps the surface; the result is valid until the next call.
    void warp(const RigSurface& surface, const VirtualView& target);

    const Texture& colour() const { return stages_->colour[1]; }    ///< rgba8, alpha 0 = nothing
    const Texture& depth_m() const { return stages_->depth_m[1]; }  ///< r32f, from the rig
    double plane_m() const { return plane_m_; }                     ///< its depth from the rig
    cv::Size margin_px() const { return margin_; }

  private:
    struct Stages {  ///< after the rows' pass and after the columns'
        Texture colour[2], depth_m[2];
        Stages(cv::Size picture, cv::Size margin);
    };
    void run(Program& pass, const Texture& colour, const Texture& depth_m, int stage, int lines);

    Program rows_, columns_;
    std::optional<Stages> stages_;
    cv::Size picture_, margin_;
    double plane_m_ = 0;
};

}  // namespace vantage
