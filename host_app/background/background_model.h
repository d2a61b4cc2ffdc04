#pragma once

#include "common/gl/fullscreen_pass.h"
#include "common/gl/tile_pass.h"
#include "common/gl/two_stage_pass.h"
#include "host_app/background/background.h"
#include "host_app/background/background_stereo.h"
#include "host_app/surfaces/rig_history.h"

namespace vantage {

/// Tells a rig's set, which stands still, from the performers before it. The set's depth and colour
/// are learnt along time, and what performers hide now is remembered; performers get a matte.
class BackgroundModel {
  public:
    explicit BackgroundModel(const ShaderLibrary& library)
        : see_(library, "background_compare.frag"),
          see_alike_(library, "background_compare.frag", {{"SAME_SIZE", "1"}}),
          tiles_(library, "matte_tiles.frag"),
          matte_(library, "matte.frag"),
          edges_(library, "matte_edges.frag"),
          learn_(library, "background_learn.frag"),
          colour_(library, "background_colour.frag"),
          known_(library, "background_sample.frag") {}

    /// Makes the rig's colour() and steady_depth() those of its set, and fills its matte(). Once an
    /// upload.
    void learn(RigHistory& rig);

    /// What was learnt, read back. Precondition: learn() of the last upload.
    static RigBackground learnt(const RigHistory& rig);
    /// Goes on from that; before learn(), of an upload without a past. Precondition: it is of the
    /// rig's camera and sizes.
    static void restore(RigHistory& rig, const RigBackground& set);
    /// Where a set is known that was read back from instants `dt_s` apart; of its depth's size.
    static cv::Mat1b known(const RigBackground& set, double dt_s);
    /// What is to be matched of it, read back, of its depth's size or a part of that. Precondition
    /// as learnt().
    static BackgroundView picture(const RigHistory& rig);
    struct Look {
        double known_share = 0;  ///< of the rig's pixels: the set is known there
        cv::Mat1b matte;         ///< the performers' share of its picture, small, 0..255
    };
    /// Reads it back. Precondition as learnt().
    Look look_at(const RigHistory& rig);

    /// Sets the inputs and uniforms of background_now.glsl from a rig; `state` is the state of its
    /// background.
    static void set_background_now(Program& program, const RigHistory& rig, const Texture& state);

    /// Instants that a pixel's depth counts at most.
    static float most_votes(const RigHistory& rig);
    /// Instants that a pixel has to have been still for before it is known to show the set.
    static float known_after(const RigHistory& rig);

  private:
    TwoStagePass see_, see_alike_;  ///< the latter where depth is as large as the picture
    FullscreenPass tiles_;
    TilePass matte_, edges_;
    FullscreenPass learn_, colour_, known_;
    DrawnTexture sampled_{TextureFormat::rg8};
    DrawnTexture hard_{TextureFormat::r8, Filter::linear};
};

/// How many instants `dt_s` apart `seconds` span, within bounds.
float instants_of(double seconds, double dt_s, int fewest, int most);

}  // namespace vantage
