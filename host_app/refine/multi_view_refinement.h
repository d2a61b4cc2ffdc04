#pragma once

#include <array>
#include <deque>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "common/gl/tile_pass.h"
#include "host_app/surfaces/instant.h"
#include "host_app/surfaces/drawn_texture.h"
#include "host_app/surfaces/rig_history.h"

namespace vantage {

/// What is to be compared of a rig: a picture with depth. Lives no longer than what it names.
struct ComparedView {
    const DepthView* seen_by = nullptr;  ///< camera and baseline
    const Texture* colour = nullptr;
    const Texture* depth_m = nullptr;  ///< metres in its first channel, 0 = unknown
    const SurfaceSamples* samples = nullptr;
    bool is_matched = false;  ///< its depth is what match_sets() found

    const DepthView& camera() const { return *seen_by; }
    std::span<const Eigen::Vector3d> sample_points_m() const { return samples->points_m; }
    double median_depth_m() const { return samples->median_depth_m; }
    Eigen::Matrix3d K_depth() const;
};

/// A rig with its steady colour and depth.
ComparedView compared(const RigHistory& rig);
std::vector<ComparedView> compared(std::span<RigHistory* const> rigs);

/// Whether as many points lie at y = 0, as exactly as stereo knows, as of a stage that shows its
/// floor.
bool shows_floor(std::span<const ComparedView> views);

/// Betters a rig's depth by what the other rigs see. A stereo rig's baseline is short: what a tenth
/// of a pixel is to it are centimetres of depth, and several pixels in a view from far aside. Other
/// rigs look from there. So depth is moved to where their pictures and this one's are most alike (a
/// narrow plane sweep around each pixel's own depth, at half size, decided in windows that keep to
/// one surface and colour), and what other rigs see through is carved away. In a map that errs
/// much, what no other rig confirms takes over the depth of confirmed pixels near it, where the
/// pictures agree better on that. Where the rigs' depths agree already nothing is moved, nor where
/// the other rigs stand no farther apart than the rig's own two cameras. Of what was matched
/// against the other rigs' sets nothing is moved, and only what was carved away, or is unknown,
/// takes over depth.
///
/// The set's depth is held against the stage's floor too, y = 0 of the world, if enough of what the
/// rigs measure lies on it: where the pictures speak as well for the floor, that is the depth.
class MultiViewRefinement {
  public:
    /// Rigs that one is compared with at the most.
    static constexpr std::size_t max_others = 3;

    /// A pass or two, or a part of one.
    using Step = std::function<void()>;

    explicit MultiViewRefinement(const ShaderLibrary& library);

    /// What `work` asks of better_set() is not drawn, but is the steps that are returned: to be
    /// done in order, and before anything else is asked of this. Textures that were returned to
    /// `work` are valid after the last one.
    std::deque<Step> in_steps(const std::function<void()>& work);
    /// Within in_steps(), the next step; else done at once.
    void then(Step step);

    /// The view's depth, bettered; as it is where no other view looks at the same things.
    /// r32f, metres, 0 = unknown, negative = guessed; valid until the next call. `all` may hold the
    /// view itself; their depths are those of the same instant.
    const Texture& better(const ComparedView& view, std::span<const ComparedView> all);
    /// The same of performers, whose depth is 0 outside some tiles of the view's picture (see
    /// TilePass): moved and carved, but nothing takes over the depth of its neighbours.
    const Texture& refine_foreground(const ComparedView& view, std::span<const ComparedView> all,
                                     const Texture& tiles);
    /// The same of the set, which may have a floor.
    const Texture& refine_background(const ComparedView& view, std::span<const ComparedView> all);

  private:
    /// How unlike the pictures are at sixteen depths, four a texture.
    struct Sweep {
        std::array<Texture, 4> cost;
        Framebuffer target;
        explicit Sweep(cv::Size size);
    };

    /// A view, those that it is compared with, and where: tiles of a picture (see TilePass).
    struct LookedAt {
        ComparedView view;
        std::vector<ComparedView> others;
        const Texture* tiles = nullptr;
        cv::Size picture;
    };
    using Look = std::shared_ptr<const LookedAt>;

    /// At `most` others; null `tiles`: everywhere.
    Look look_at(const ComparedView& view, std::span<const ComparedView> all, std::size_t most,
                 const Texture* tiles = nullptr) const;
    const Texture& better(const Look& look);
    /// The first channel is the depth as it was moved and carved, the second what is known of it
    /// (see rig_carve.frag); without that where nothing was moved; the view's own where no other
    /// looks.
    const Texture& move_and_carve(const Look& look);
    /// Draws the tiles that are looked at. `unit`: a free one.
    static void draw(TilePass& pass, const Framebuffer& target, int unit, const Look& look);
    void bind_view(Program& program, const Texture& depth_m, const ComparedView& view) const;
    /// Also the other views, up to the texture unit that is returned.
    int bind_others(Program& program, const Texture& depth_m, const Look& look) const;
    /// How far the view's middle moves in the others' pictures, at most, if its inverse depth
    /// changes by all of itself; px of its depth map.
    static double parallax_px(const Look& look);
    /// Whether the others stand far enough apart to tell something new.
    static bool tell_news(const ComparedView& view, double parallax_px);
    void compare(const Look& look, double parallax_px);
    /// Fills half_before_ and half_.
    void refine(const Look& look, double parallax_px);
    void sweep(const Look& look, double relative_step);
    void smooth(TilePass& pass, const Texture& depth_m, const Look& look,
                const Framebuffer& target) const;

    std::deque<Step>* steps_ = nullptr;  ///< null: nothing is put off
    TilePass halve_, smooth_, refine_;
    /// One for every number of other views.
    std::vector<TilePass> sweep_, agreement_pass_, carve_, move_and_carve_, adopt_, floor_;
    Texture whole_{TextureFormat::r8, 1, 1};  ///< one tile
    std::unique_ptr<Sweep> costs_;
    DrawnTexture half_before_{TextureFormat::r32f}, result_{TextureFormat::r32f};
    DrawnTexture with_floor_{TextureFormat::r32f};
    DrawnTexture judged_{TextureFormat::rg32f};
    DrawnTexture agreement_{TextureFormat::rgba16f, Filter::linear, true};
    DrawnInTurn half_{TextureFormat::r32f};
};

}  // namespace vantage
