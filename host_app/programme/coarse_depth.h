#pragma once

#include <algorithm>

#include "common/gl/fullscreen_pass.h"
#include "common/gl/objects/readback.h"
#include "host_app/surfaces/drawn_texture.h"

namespace vantage {

/// Reduces the depth of a rendered frame to a coarse grid, with the inverse of the nearest depth in
/// each cell, and reads it back. The context that was current at construction must be current at
/// every call.
class CoarseDepth {
  public:
    explicit CoarseDepth(const ShaderLibrary& library) : pass_(library, "coarse_depth.frag") {}

    /// Starts the reduction; `depth_m` is that of ViewRenderer::depth_m().
    void begin(const Texture& depth_m) {
        const cv::Size size = depth_m.size();
        const int columns = std::min(max_columns, size.width);
        const cv::Size cells(columns, std::max(1, size.height * columns / size.width));
        grid_.resize(cells);
        Program& program = pass_.use();
        program.input("depth_m", depth_m);
        program.set("cells", Eigen::Vector2i(cells.width, cells.height));
        pass_.draw(grid_.target());
        readback_.begin(grid_.texture());
    }
    bool is_begun() const { return readback_.is_begun(); }
    /// Waits for the grid: inverse depth in 1/m, 0 without a surface, with the aspect ratio of the
    /// frame. Precondition: is_begun().
    cv::Mat1f take() { return readback_.take(); }

  private:
    static constexpr int max_columns = 160;

    FullscreenPass pass_;
    DrawnTexture grid_{TextureFormat::r32f};
    Readback readback_;
};

}  // namespace vantage
