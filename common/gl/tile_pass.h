#pragma once

#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/program.h"
#include "common/gl/objects/vertex_array.h"

namespace vantage {

/// Runs a fragment shader for the pixels of some tiles of a framebuffer, with
/// shaders/shared/tiles.vert: what has nothing to do far from where something happens costs nothing
/// there. Which tiles is known to the GPU alone.
class TilePass {
  public:
    static constexpr int side_px = 16;
    /// Of the tiles of a picture: the last ones may reach beyond it.
    static cv::Size tiles_of(cv::Size picture) {
        return {(picture.width + side_px - 1) / side_px, (picture.height + side_px - 1) / side_px};
    }
    /// What a tile spans of the picture's width and height.
    static Eigen::Vector2f share_of(cv::Size picture) {
        return {static_cast<float>(side_px) / static_cast<float>(picture.width),
                static_cast<float>(side_px) / static_cast<float>(picture.height)};
    }

    TilePass(const ShaderLibrary& library, std::string fragment, ShaderDefines defines = {});

    /// The program, in use and ready for uniforms.
    Program& use();
    /// Makes the target 0 and draws the tiles of a picture of `picture` pixels, which covers the
    /// target, where `tiles` (a pixel a tile) is above 0, with the program in use. Binds `tiles` to
    /// `unit`.
    void draw(const Framebuffer& target, const Texture& tiles, GLuint unit, cv::Size picture);

  private:
    Program program_;
    VertexArray vertices_;
    int slice_rows_ = 0;
};

}  // namespace vantage
