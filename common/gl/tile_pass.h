#pragma once

#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/program.h"
#include "common/gl/objects/vertex_array.h"

namespace vantage {

/// Runs a fragment shader for the pixels of selected tiles of a framebuffer, with
/// shaders/shared/tiles.vert. The selection is a texture that only the GPU reads; tiles outside it
/// cost nothing.
class TilePass {
  public:
    static constexpr int side_px = 16;
    /// The number of tiles that cover a picture; the last ones may reach beyond it.
    static cv::Size tiles_of(cv::Size picture) {
        return {(picture.width + side_px - 1) / side_px, (picture.height + side_px - 1) / side_px};
    }
    /// The share of the picture's width and height that a tile spans.
    static Eigen::Vector2f share_of(cv::Size picture) {
        return {static_cast<float>(side_px) / static_cast<float>(picture.width),
                static_cast<float>(side_px) / static_cast<float>(picture.height)};
    }

    TilePass(const ShaderLibrary& library, std::string fragment, ShaderDefines defines = {});

    /// The program, in use and ready for uniforms.
    Program& use();
    /// Clears the target to 0, then draws with the program in use the tiles where `tiles` (one
    /// pixel per tile) is above 0. The tiles divide a picture of `picture` pixels that covers the
    /// target.
    void draw(const Framebuffer& target, const Texture& tiles, cv::Size picture);

  private:
    Program program_;
    VertexArray vertices_;
    int slice_rows_ = 0;
};

}  // namespace vantage
