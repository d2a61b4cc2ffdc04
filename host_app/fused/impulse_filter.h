#pragma once

#include "common/gl/two_stage_pass.h"
#include "host_app/surfaces/drawn_texture.h"
#include "host_app/views/tolerances.h"

namespace vantage {

/// Removes single wrong pixels at depth edges: where depth errs by a pixel, one pixel of another
/// surface's colour stands alone. A pixel at a depth edge that is brighter or darker in a channel
/// than all but one of its eight neighbours, by more than the tolerance, becomes the median of the
/// nine (a conditional median filter: Sun and Neuvo, 1994). Lines of one pixel's width and the
/// inside of surfaces stay unchanged. Belongs to one context.
class ImpulseFilter {
  public:
    /// Grey levels of 255. The noise of a camera stays below it.
    static constexpr int tolerance = 20;

    explicit ImpulseFilter(const ShaderLibrary& library) : pass_(library, "impulse_filter.frag") {}

    /// `depth_m` is r32f, 0 where there is nothing; its sign has no meaning. Returns the filtered
    /// image, rgba8 with unchanged alpha; valid until the next call.
    const Texture& filter(const Texture& picture, const Texture& depth_m) {
        filtered_.resize(picture.size());
        pass_.draw(filtered_.target(), [&](Program& program) {
            program.input("picture", picture);
            program.input("depth_m", depth_m);
            program.set("tolerance", static_cast<float>(tolerance) / 255);
            program.set("edge_ratio", depth_edge_ratio);
        });
        return filtered_.texture();
    }

  private:
    TwoStagePass pass_;
    DrawnTexture filtered_{TextureFormat::rgba8, Filter::linear, false, DrawnWith::depth_test};
};

}  // namespace vantage
