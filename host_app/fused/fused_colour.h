#pragma once

#include <vector>

#include "common/gl/fullscreen_pass.h"
#include "common/gl/two_stage_pass.h"
#include "host_app/surfaces/drawn_texture.h"
#include "host_app/synthesis/rig_layers.h"

namespace vantage {

/// Finds the surface that counts at every pixel of a virtual view, from all rigs' surfaces there.
/// Belongs to one context.
class FusedDepth {
  public:
    explicit FusedDepth(const ShaderLibrary& library);

    /// Precondition: at least one layer was drawn. The result is r32f in the view's size, metres,
    /// 0 = nothing, negative = inpainted; valid until the next call.
    const Texture& find(const RigLayers& layers, cv::Size size);

  private:
    std::vector<TwoStagePass> passes_;  ///< one for every number of layers
    DrawnTexture depth_m_{TextureFormat::r32f, Filter::nearest, false, DrawnWith::depth_test};
};

/// Colours the fused surface of a virtual view in three passes, so that no pixel costs more than it
/// needs. Most pixels lie inside a surface that the two most useful rigs see well; others also
/// sample the other rigs; pixels beside depth edges compare two surfaces in all rigs. Belongs to
/// one context.
class FusedColour {
  public:
    explicit FusedColour(const ShaderLibrary& library);

    /// Classifies the pixels of the fused surface (r32f, metres, 0 = nothing, negative =
    /// inpainted). Call it before draw(). Returns the depth texture that draw()'s target must have.
    const Texture& sort(const Texture& fused_depth);

    /// Draws the image at low cost, with hard depth edges; needs no sort().
    void draw_plainly(const RigLayers& layers, const Texture& fused_depth, const DepthPicture& into,
                      bool notes_origins);

    /// Draws the image of a baked background (see BakedPainter) behind a foreground (see
    /// ForegroundLayers::show_alone()) at low cost: the colours of this instant from the rigs that
    /// saw the surface when it was baked and still have it, and the baked colours elsewhere.
    /// `baked` is drawn for the layers' rigs.
    void draw_on_baked(const RigLayers& layers, const DepthPicture& baked,
                       const DepthPicture& foreground, const DepthPicture& into,
                       bool notes_origins);

    /// Draws the image. The target's depth texture is the one that sort() returned.
    void draw(const RigLayers& layers, const Texture& fused_depth, const DepthPicture& into,
              bool notes_origins);

  private:
    FullscreenPass kinds_pass_;
    FullscreenPass& use(LayerPass& pass, const RigLayers& layers, const Texture& fused_depth,
                        bool notes_origins);

    LayerPass first_rigs_, inner_, edges_, plain_, on_baked_;
    DrawnDepth kinds_;
};

}  // namespace vantage
