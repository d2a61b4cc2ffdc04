#pragma once

#include <array>
#include <deque>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "common/gl/tile_pass.h"
#include "host_app/surfaces/drawn_texture.h"
#include "host_app/surfaces/instant.h"
#include "host_app/surfaces/rig_history.h"

namespace vantage {

/// A rig's picture and depth, for comparison with other rigs. Refers to the rig's objects, which
/// must outlive it.
struct ComparedView {
    const DepthView* seen_by = nullptr;  ///< camera and baseline
    const Texture* colour = nullptr;
    const Texture* depth_m = nullptr;  ///< metres in its first channel, 0 = unknown
    const SurfaceSamples* samples = nullptr;
    bool is_matched = false;  ///< its depth comes from match_backgrounds()

    const DepthView& camera() const { return *seen_by; }
    std::span<const Eigen::Vector3d> sample_points_m() const { return samples->points_m; }
    double median_depth_m() const { return samples->median_depth_m; }
    Eigen::Matrix3d K_depth() const;
};

/// The view of a rig with its denoised colour and steady depth.
ComparedView compared(const RigHistory& rig);
std::vector<ComparedView> compared(std::span<RigHistory* const> rigs);

/// Whether enough surface points lie at y = 0 of the world, within the uncertainty of stereo, for
/// the rigs to see the stage's floor.
bool shows_floor(std::span<const ComparedView> views);

/// Multi-view refinement: corrects a rig's depth with the pictures and depths of the other rigs.
/// The baseline of a stereo rig is short, so that a tenth of a pixel is centimetres of depth, and
/// several pixels in a view from the side, where the other rigs stand.
///
/// 1. Plane sweep: depth moves to where the rigs' pictures match best, at half size, within a few
///    steps of the present depth, decided in windows that keep to one surface and colour. Skipped
///    where the depths of the rigs are consistent already, and where the other rigs stand no
///    farther apart than the rig's own two cameras.
/// 2. Consistency check: depth that other rigs see through is carved away.
/// 3. Adoption: in a map that errs, pixels that no other rig confirms take the depth of confirmed
///    pixels near them if the pictures match better with it.
/// 4. Floor (background only): depth moves to the stage's floor, y = 0 of the world, where the
///    pictures match as well there, if the rigs see a floor at all.
///
/// Depth from background stereo is not moved, and only its carved and unknown pixels adopt depth.
/// Belongs to the thread and GL context that it was made on.
class MultiViewRefinement {
  public:
    /// Other rigs that one rig is compared with, at most: the shaders' OTHERS.
    static constexpr std::size_t max_others = 3;

    /// A few draws, short enough to run between two pictures.
    using Step = std::function<void()>;

    explicit MultiViewRefinement(const ShaderLibrary& library);

    /// Runs `work`, whose calls of refine_background() draw nothing; returns their draws as steps.
    /// The caller runs the steps in order, before it calls anything else of this object. Textures
    /// that `work` got are valid after the last step.
    std::deque<Step> in_steps(const std::function<void()>& work);
    /// Adds a step within in_steps(); otherwise runs it at once.
    void then(Step step);

    /// Returns the view's refined depth, or its own if no other view sees the same places: r32f,
    /// metres, 0 = unknown, negative = inpainted; valid until the next call. `all` may contain the
    /// view itself; all must be of one instant.
    const Texture& refine(const ComparedView& view, std::span<const ComparedView> all);
    /// Returns the refined depth of the foreground, which is 0 outside some tiles of the view's
    /// picture (see TilePass): without adoption.
    const Texture& refine_foreground(const ComparedView& view, std::span<const ComparedView> all,
                                     const Texture& tiles);
    /// Returns the refined depth of the background, with the floor.
    const Texture& refine_background(const ComparedView& view, std::span<const ComparedView> all);

  private:
    /// Photometric costs at sixteen depths, four in each texture.
    struct Sweep {
        std::array<Texture, 4> cost;
        Framebuffer target;
        explicit Sweep(cv::Size size);
    };

    /// A view, the views that it is compared with, and the tiles of its picture (see TilePass).
    struct ViewGroup {
        ComparedView view;
        std::vector<ComparedView> others;
        const Texture* tiles = nullptr;
        cv::Size picture;
    };
    using Group = std::shared_ptr<const ViewGroup>;

    /// Selects the max_others most useful views. Null `tiles` means the whole picture.
    Group group(const ComparedView& view, std::span<const ComparedView> all,
                const Texture* tiles = nullptr) const;
    const Texture& refine(const Group& group);
    /// Returns the depth after plane sweep and consistency check: rg32f with the result of the
    /// check (see rig_carve.frag), r32f without it if there was no sweep, or the view's own depth
    /// if there are no other views.
    const Texture& move_and_carve(const Group& group);
    /// Draws the group's tiles.
    static void draw(TilePass& pass, const Framebuffer& target, const Group& group);
    static void set_view(Program& program, const Texture& depth_m, const ComparedView& view);
    /// Sets the inputs and uniforms of rig_others.glsl.
    static void set_others(Program& program, const Texture& depth_m, const Group& group);
    /// The largest parallax_px() of the view's median depth in the others' pictures.
    static double parallax_px(const Group& group);
    /// Whether the others stand far enough apart to measure depth better than the view's own pair.
    static bool has_wide_baseline(const ComparedView& view, double parallax_px);
    void check_consistency(const Group& group, double parallax_px);
    /// Fills half_before_ and half_: the half-size map before and after the plane sweeps.
    void sweep(const Group& group, double parallax_px);
    void sweep_once(const Group& group, double relative_step);
    static void smooth(TilePass& pass, const Texture& depth_m, const Group& group,
                       const Framebuffer& target);

    std::deque<Step>* steps_ = nullptr;  ///< null outside in_steps()
    TilePass halve_, smooth_, refine_;
    /// One pass for every number of other views.
    std::vector<TilePass> sweep_, consistency_pass_, carve_, move_and_carve_, adopt_, floor_;
    Texture whole_{TextureFormat::r8, 1, 1};  ///< one tile that covers everything
    std::unique_ptr<Sweep> costs_;
    DrawnTexture half_before_{TextureFormat::r32f}, result_{TextureFormat::r32f};
    DrawnTexture with_floor_{TextureFormat::r32f};
    DrawnTexture judged_{TextureFormat::rg32f};
    DrawnTexture consistency_{TextureFormat::rgba16f, Filter::linear, true};
    DrawnInTurn half_{TextureFormat::r32f};
};

}  // namespace vantage
