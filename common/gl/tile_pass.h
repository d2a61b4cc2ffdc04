#pragma once

#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/program.h"
#include "common/gl/objects/vertex_array.h"

namespace vantage {

/// Runs a fragment shader for the pixels of selected tiles of a framebuffer, with
/// shaders/shared/tiles.vert, so that pixels outside them cost nothing. The selection exists only
/// on the GPU.
class TilePass {
  public:
    static constexpr int side_px = 16;
    /// The number of tiles that cover an image; the last ones may reach beyond it.
    static cv::Size tiles_of(cv::Size picture) {
        return {(picture.width + side_px - 1) / side_px, (picture.height + side_px - 1) / side_px};
    }
    /// The size of a tile as a share of the image's width and height.
    static Eigen::Vector2f share_of(cv::Size picture) {
        return {static_cast<float>(side_px) / static_cast<float>(picture.width),
                static_cast<float>(side_px) / static_cast<float>(picture.height)};
    }

    TilePass(const ShaderLibrary& library, std::string fragment, ShaderDefines defines = {});

    /// The program, in use and ready for uniforms.
    Program& use();
    /// Clears the target to 0 and draws, with the program in use, the tiles of an image of
    /// `picture` pixels whose pixel in `tiles` (one per tile) is above 0. The image covers the
    /// target. Binds `tiles` to `unit`.
    void draw(const Framebuffer& target, const Texture& tiles, GLuint unit, cv::Size picture);

  private:
    Program program_;
    VertexArray vertices_;
    int slice_rows_ = 0;
};

}  // namespace vantage
