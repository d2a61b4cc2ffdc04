#pragma once

#include "common/gl/fullscreen_pass.h"
#include "common/gl/tile_pass.h"
#include "common/gl/two_stage_pass.h"
#include "host_app/background/background.h"
#include "host_app/background/background_stereo.h"
#include "host_app/surfaces/rig_history.h"

namespace vantage {

/// The background model: separates a rig's background, which stands still, from the foreground. It
/// learns depth and colour of the background over time, remembers them where foreground hides them,
/// and draws the foreground's matte. Belongs to the GL context that it was made on.
class BackgroundModel {
  public:
    explicit BackgroundModel(const ShaderLibrary& library)
        : compare_(library, "background_compare.frag"),
          compare_same_size_(library, "background_compare.frag", {{"SAME_SIZE", "1"}}),
          tiles_(library, "matte_tiles.frag"),
          matte_(library, "matte.frag"),
          edges_(library, "matte_edges.frag"),
          learn_(library, "background_learn.frag"),
          colour_(library, "background_colour.frag"),
          known_(library, "background_sample.frag") {}

    /// Updates the background from the rig's last upload: colour() and steady_depth() become those
    /// of the background, and matte() is drawn. At most once for each upload.
    void learn(RigHistory& rig);

    /// Reads the background back. Precondition: learn() of the last upload.
    static RigBackground learnt(const RigHistory& rig);
    /// Continues from a saved background; to be called before learn(), for an upload without a
    /// history. Precondition: camera and sizes are the rig's.
    static void restore(RigHistory& rig, const RigBackground& background);
    /// Where a background that was learnt from instants `dt_s` apart is known; of its depth's size.
    static cv::Mat1b known(const RigBackground& background, double dt_s);
    /// Reads back the input of background stereo, in the depth's size or smaller. Precondition as
    /// for learnt().
    static BackgroundView picture(const RigHistory& rig);
    struct Look {
        double known_share = 0;    ///< of the rig's pixels, those whose background is known
        double changed_share = 0;  ///< those whose background has changed since its model was made
        cv::Mat1b matte;           ///< reduced, 0..255
    };
    /// Reads back a summary for operators. Precondition as for learnt().
    Look look_at(const RigHistory& rig);

    /// Sets the inputs and uniforms of background_now.glsl from a rig; `state` is the state of its
    /// background.
    static void set_background_now(Program& program, const RigHistory& rig, const Texture& state);

    /// Sets the inputs and uniforms of background_changed.glsl from a rig.
    static void set_model_then(Program& program, const RigHistory& rig);

    /// Instants in the mean of a pixel's depth, at most.
    static float max_instants(const RigHistory& rig);
    /// Instants without change after which a pixel's background is known.
    static float known_after(const RigHistory& rig);

  private:
    TwoStagePass compare_;
    TwoStagePass compare_same_size_;  ///< if the depth map has the picture's size
    FullscreenPass tiles_;
    TilePass matte_, edges_;
    FullscreenPass learn_, colour_, known_;
    DrawnTexture sampled_{TextureFormat::rgba8};
    DrawnTexture hard_{TextureFormat::r8, Filter::linear};
};

/// The number of instants `dt_s` apart in `seconds`, within min and max.
float instants_of(double seconds, double dt_s, int min, int max);

}  // namespace vantage
