#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/gl/objects/texture.h"
#include "common/gl/shader_library.h"
#include "host_app/pipeline/instant_preparer.h"
#include "host_app/synthesis/synthesiser_options.h"

namespace vantage {

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

/// How well a view is rendered, and so at what cost. The governor moves along render_levels().
struct RenderLevel {
    int rank = 0;  ///< 0: the best; a higher one is cheaper
    std::size_t rigs = most_drawn_rigs;
    /// So many rigs' surfaces are drawn by every pixel, the others' by a quarter of the quads.
    /// Where there are no more rigs than a picture takes, all are at rank 0.
    std::size_t finely = 2;
    double scale = 1;       ///< of the picture that is rendered to the one that is shown
    bool is_plain = false;  ///< every pixel is coloured by the same little work
};

/// From the best to the cheapest, by rank.
std::span<const RenderLevel> render_levels();

/// Renders views of instants, on the GPU. Belongs to one thread and to the context that was current
/// at construction; instants may come from a preparer on another context that shares objects.
class ViewRenderer {
  public:
    virtual ~ViewRenderer() = default;

    /// The result is an rgba8 texture of the view's size, top row first, owned by the renderer and
    /// valid until the next call. Alpha is 255 where a rig saw the surface, and below 128 where the
    /// pixel was filled in or stayed empty (this is what `coverage` counts): remembered_alpha where
    /// a rig saw it at an instant before.
    virtual const Texture& render(const Instant& instant, const VirtualView& view,
                                  const RenderLevel& level) = 0;

    /// Lets render() note, or no longer note, which rigs its pixels come from. False: this one
    /// cannot tell.
    virtual bool note_origins(bool noted) { return !noted; }
    /// Of the last picture; null if they were not noted. Valid until the next call.
    virtual const PixelOrigins* origins() const { return nullptr; }

    /// Of the last picture: r32f, of its size, along the camera's axis; 0 where nothing is, and the
    /// magnitude alone counts. Null: this one cannot tell. Valid until the next call.
    virtual const Texture* depth_m() const { return nullptr; }

    /// What an instant lacks for a picture of this view: a sentence with the mend. Empty: nothing.
    /// What is rendered all the same is black and not covered.
    virtual std::string lacks(const Instant& /*instant*/, const VirtualView& /*view*/) const {
        return {};
    }
};

/// One registered synthesiser: host_app/synthesis/synthesisers/NAME_synthesiser.cpp, or
/// gallery/NAME_synthesiser.cpp, defines NAME_synthesiser_entry().
struct SynthesiserEntry {
    std::string name;
    std::string summary;
    std::function<std::unique_ptr<InstantPreparer>(const ShaderLibrary&)> make_preparer;
    std::function<std::unique_ptr<ViewRenderer>(const ShaderLibrary&)> make_renderer;
    bool tells_origins = true;  ///< which rigs its pixels come from
    bool needs_depth = true;    ///< of one view at least
    std::vector<SynthesiserOption> options = {};
    /// Of those with options, instead of make_renderer, which find_synthesiser() makes of it.
    std::function<std::unique_ptr<ViewRenderer>(const ShaderLibrary&, const SynthesiserChoices&)>
        make_renderer_with = {};
};
/// The product's own.
std::vector<SynthesiserEntry> synthesiser_entries();
/// The gallery: historic ones, which run on the same rigs, takes and view sets (docs/gallery.md).
std::vector<SynthesiserEntry> gallery_entries();
/// The names and summaries of all, the gallery's and their options apart, for help.
std::string synthesisers_help();

/// The name of the one to use where nobody asks for another.
inline constexpr const char* default_synthesiser = "fused";

/// The names of all as the type of an option, "{fused,points} or gallery {mesh}".
std::string synthesisers_type_name();

/// One of the product's own or of the gallery, by "NAME" or "NAME:OPTION=VALUE,...", which becomes
/// the entry's name. Throws Error that lists the known names if it is none of them, or the known
/// options.
SynthesiserEntry find_synthesiser(const std::string& name);

/// Preparing and rendering on one context, at the best level: for pictures that need not be live.
class Synthesiser {
  public:
    Synthesiser(const SynthesiserEntry& entry, const ShaderLibrary& library)
        : preparer_(entry.make_preparer(library)), renderer_(entry.make_renderer(library)) {}

    /// Takes the next instant. Views may differ in size, lack depth, or be one or none.
    void set_views(std::span<const DepthView> views, double dt_s = 1.0 / 30) {
        preparer_->take(views, dt_s);
    }
    void cut() { preparer_->cut(); }
    /// As ViewRenderer::render(). Throws Error with what the instant lacks for it.
    const Texture& render(const VirtualView& view);
    bool note_origins(bool noted) { return renderer_->note_origins(noted); }
    const PixelOrigins* origins() const { return renderer_->origins(); }

  private:
    std::unique_ptr<InstantPreparer> preparer_;
    std::unique_ptr<ViewRenderer> renderer_;
    std::shared_ptr<const Instant> instant_;  ///< of the picture that was rendered last
};

/// Throws Error as find_synthesiser().
std::unique_ptr<Synthesiser> make_synthesiser(const std::string& name,
                                              const ShaderLibrary& library);

}  // namespace vantage
