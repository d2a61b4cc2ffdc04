#pragma once

#include <optional>
#include <span>
#include <string>

#include "common/gl/objects/program.h"
#include "common/gl/objects/vertex_array.h"
#include "host_app/baked/baked_surface.h"
#include "host_app/surfaces/depth_picture.h"
#include "host_app/surfaces/drawn_texture.h"
#include "host_app/views/virtual_view.h"

namespace vantage {

/// Draws a baked background in a virtual view: its mesh once, with a depth test, and at each pixel
/// the colours of the rigs that see the surface, weighted by how close they look. Belongs to one
/// context.
class BakedPainter {
  public:
    explicit BakedPainter(const ShaderLibrary& library);

    /// Alpha of the picture is 1 where a rig sees the surface, `remembered_alpha` (0..1) where one
    /// saw it before, less where depth is inpainted, and 0 where there is no surface.
    ///
    /// @param origins the rigs whose shares are recorded; empty: none are
    /// @param is_plain bilinear colours instead of sharp ones
    /// @return valid until the next call
    const DepthPicture& draw(const BakedInstant& instant, const VirtualView& target, double near_m,
                             std::span<const std::string> origins, bool is_plain,
                             float remembered_alpha);

  private:
    void draw_part(const BakedInstant& instant, const BakedSurface::Part& part,
                   const VirtualView& target, double near_m, std::span<const std::string> origins,
                   std::size_t sources, Program& program);
    Program& program_of(bool is_plain, bool has_origins);

    const ShaderLibrary* library_;
    std::optional<Program> programs_[2][2];
    VertexArray vertices_;
    DepthPicture picture_;
    DrawnDepth depth_;
};

}  // namespace vantage
