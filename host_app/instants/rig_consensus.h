#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "common/gl/fullscreen_pass.h"
#include "host_app/instants/drawn_texture.h"
#include "host_app/instants/instant_preparer.h"
#include "host_app/instants/rig_history.h"

namespace vantage {

/// Betters a rig's depth by what the other rigs see. A stereo rig's baseline is short: what a tenth
/// of a pixel is to it are centimetres of depth, and several pixels in a view from far aside. Other
/// rigs look from there. So depth is moved to where their pictures and this one's are most alike (a
/// narrow plane sweep around each pixel's own depth, at half size, decided in windows that keep to
/// one surface and colour), and what other rigs see through is carved away. In a map that errs
/// much, what no other rig confirms takes over the depth of confirmed pixels near it, where the
/// pictures agree better on that. Where the rigs' depths agree already nothing is moved, nor where
/// the other rigs stand no farther apart than the rig's own two cameras.
class RigConsensus {
  public:
    explicit RigConsensus(const ShaderLibrary& library);

    /// The view's steady depth, bettered; as it is where no other view looks at the same things.
    /// r32f, metres, 0 = unknown, negative = guessed; valid until the next call. `all` may hold the
    /// view itself; their steady depths are those of the same instant.
    const Texture& better(const RigHistory& view, std::span<const std::unique_ptr<RigHistory>> all,
                          PrepareLevel::Refinement refinement = PrepareLevel::Refinement::sweep);

  private:
    /// How unlike the pictures are at sixteen depths, four a texture.
    struct Sweep {
        std::array<Texture, 4> unlike;
        Framebuffer target;
        explicit Sweep(cv::Size size);
    };
    static constexpr std::size_t max_others = 3;

    void bind_view(Program& program, const Texture& depth_m, const RigHistory& view) const;
    /// Also the other views, up to the texture unit that is returned.
    int bind_others(Program& program, const Texture& depth_m, const RigHistory& view) const;
    /// How far the view's middle moves in the others' pictures, at most, if its inverse depth
    /// changes by all of itself; px of its depth map.
    double parallax_px(const RigHistory& view) const;
    void compare(const RigHistory& view, double parallax_px);
    /// Fills half_before_ and half_.
    void refine(const RigHistory& view, double parallax_px);
    void sweep(const RigHistory& view, double relative_step);
    void smooth(FullscreenPass& pass, const Texture& depth_m, const RigHistory& view,
                const Framebuffer& target) const;

    FullscreenPass halve_, smooth_, refine_;
    /// One for every number of other views.
    std::vector<FullscreenPass> sweep_, agreement_pass_, carve_, move_and_carve_, adopt_;
    std::vector<const RigHistory*> others_;
    std::unique_ptr<Sweep> costs_;
    DrawnTexture half_before_{TextureFormat::r32f}, result_{TextureFormat::r32f};
    DrawnTexture judged_{TextureFormat::rg32f};
    DrawnTexture agreement_{TextureFormat::rgba16f, Filter::linear, true};
    DrawnInTurn half_{TextureFormat::r32f};
};

}  // namespace vantage
