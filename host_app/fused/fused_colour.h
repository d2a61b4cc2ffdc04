#pragma once

#include "common/gl/fullscreen_pass.h"
#include "host_app/surfaces/depth_picture.h"
#include "host_app/surfaces/drawn_texture.h"
#include "host_app/synthesis/layer_pass.h"

namespace vantage {

/// Colours the surface that was found for every pixel of a virtual view, no pixel by more work than
/// it takes: most lie within a surface that the two most useful rigs see well, and are done with
/// these; then come those that other rigs have a say in, and those beside depth edges, where all
/// rigs are asked about two surfaces.
class FusedColour {
  public:
    explicit FusedColour(const ShaderLibrary& library);

    /// To be called before draw(): tells the pixels of the found surface (r32f, metres, 0 =
    /// nothing, negative = guessed) apart. The depth texture that the picture is to be drawn with.
    const Texture& sort(const Texture& fused_depth);

    /// The picture at little cost, with hard depth edges; needs no sort().
    void draw_plainly(const RigLayers& layers, const Texture& fused_depth, const DepthPicture& into,
                      bool notes_origins);

    /// Draws the picture; its target has what sort() returned.
    void draw(const RigLayers& layers, const Texture& fused_depth, const DepthPicture& into,
              bool notes_origins);

  private:
    FullscreenPass kinds_pass_;
    FullscreenPass& use(LayerPass& pass, const RigLayers& layers, const Texture& fused_depth,
                        bool notes_origins);

    LayerPass first_rigs_, inner_, edges_, plain_;
    DrawnDepth kinds_;
};

}  // namespace vantage
