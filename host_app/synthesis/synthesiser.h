#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/gl/shader_library.h"
#include "common/gl/texture.h"
#include "host_app/synthesis/depth_view.h"

namespace vantage {

/// The camera that is rendered: a pinhole with any intrinsics.
struct VirtualView {
    int width_px = 0, height_px = 0;
    Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
    Pose world_from_camera = Pose::Identity();
};

/// Alpha of pixels that no rig sees now, but one saw before what hides them came.
inline constexpr unsigned char remembered_alpha = 96;

/// Which rigs a picture's pixels come from.
struct PixelOrigins {
    static constexpr std::size_t max_rigs = 4;

    /// rgba8, of the picture's size: channel i is the share of rigs[i] in the pixel's colour. The
    /// shares of a pixel add up to 1, or to 0 where the colour is no rig's.
    const Texture* shares = nullptr;
    std::vector<std::string> rigs;  ///< at most max_rigs; a rig may be there twice
};

/// Renders one view from several rigs' depth views, on the GPU. The context that was current at
/// construction must be current at every call.
class Synthesiser {
  public:
    virtual ~Synthesiser() = default;

    /// Takes the newest instant; uploads what changed. Views may differ in size, lack depth, or be
    /// one or none.
    virtual void set_views(std::span<const DepthView> views) = 0;

    /// The next instant does not follow the last one (a cut, or time that is gone through): what
    /// was learnt along time is not to be shown in it.
    virtual void forget() {}

    /// Renders. The result is an rgba8 texture of the view's size, top row first, owned by the
    /// synthesiser and valid until the next call. Alpha is 255 where a rig saw the surface, and
    /// below 128 where the pixel was filled in or stayed empty (this is what `coverage` counts):
    /// remembered_alpha where a rig saw it at an instant before.
    virtual const Texture& render(const VirtualView& view) = 0;

    /// Lets render() note, or no longer note, which rigs its pixels come from. False: this one
    /// cannot tell.
    virtual bool note_origins(bool noted) { return !noted; }
    /// Of the last picture; null if they were not noted. Valid until the next call.
    virtual const PixelOrigins* origins() const { return nullptr; }
};

/// One registered synthesiser: host_app/synthesis/synthesisers/NAME_synthesiser.cpp defines
/// NAME_synthesiser_entry().
struct SynthesiserEntry {
    std::string name;
    std::string summary;
    std::function<std::unique_ptr<Synthesiser>(const ShaderLibrary&)> make;
};
std::vector<SynthesiserEntry> synthesiser_entries();

/// The name of the one to use where nobody asks for another.
inline constexpr const char* default_synthesiser = "fused";

/// Throws Error that lists the known names if `name` is none of them.
std::unique_ptr<Synthesiser> make_synthesiser(const std::string& name,
                                              const ShaderLibrary& library);

}  // namespace vantage
