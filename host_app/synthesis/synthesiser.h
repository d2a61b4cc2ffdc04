#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/gl/objects/texture.h"
#include "common/gl/shader_library.h"
#include "host_app/pipeline/instant_preparer.h"

namespace vantage {

/// An option of a synthesiser: one of several words, or a number.
struct SynthesiserOption {
    std::string name;  ///< with its unit: "focal-m"
    std::string summary;
    std::string by_default;
    std::vector<std::string> words;  ///< the allowed words; empty: a number within the limits
    double least = 0, most = 0;
};

/// The values of all options of a synthesiser, chosen or default.
class SynthesiserChoices {
  public:
    /// Parses "NAME=VALUE,NAME=VALUE..." or an empty text. Throws Error, which names the option and
    /// the allowed values, if something does not fit.
    SynthesiserChoices(std::string_view synthesiser, std::string_view text,
                       std::span<const SynthesiserOption> options);

    /// Precondition: one of the synthesiser's options.
    const std::string& word(const std::string& name) const { return values_.at(name); }
    double number(const std::string& name) const;

  private:
    std::map<std::string, std::string> values_;
};

/// Alpha of pixels that are hidden from all rigs now and were seen by one before.
inline constexpr unsigned char remembered_alpha = 96;

/// The rigs that an image's pixels come from.
struct PixelOrigins {
    static constexpr std::size_t max_rigs = 4;

    /// rgba8, in the image's size: channel i is the share of rigs[i] in the pixel's colour. The
    /// shares of a pixel add up to 1, or to 0 where no rig contributed.
    const Texture* shares = nullptr;
    std::vector<std::string> rigs;  ///< at most max_rigs; a rig may occur twice
};

/// A quality level of rendering and so its cost. The governor moves along render_levels().
struct RenderLevel {
    int rank = 0;  ///< 0 is the best; a higher rank costs less
    std::size_t rigs = most_drawn_rigs;
    /// Number of rigs whose surfaces are drawn with one vertex per pixel; the others' surfaces have
    /// a quarter of the quads. At rank 0 all are fine if the stage has at most most_drawn_rigs.
    std::size_t finely = 2;
    double scale = 1;       ///< size of the rendered image relative to the shown one
    bool is_plain = false;  ///< colours every pixel with the same small amount of work
};

/// All rendering levels from the best to the cheapest, ordered by rank.
std::span<const RenderLevel> render_levels();

/// Renders virtual views of instants on the GPU. Belongs to one thread and to the context that was
/// current at construction. Instants may come from a preparer on another context of the same group.
class ViewRenderer {
  public:
    virtual ~ViewRenderer() = default;

    /// Returns an rgba8 texture of the view's size, top row first, which the renderer owns; valid
    /// until the next call. Alpha is 255 where a rig sees the surface and below 128 where the pixel
    /// was filled or is empty, which `coverage` counts; it is remembered_alpha where a rig saw the
    /// surface at an earlier instant.
    virtual const Texture& render(const Instant& instant, const VirtualView& view,
                                  const RenderLevel& level) = 0;

    /// Lets render() record which rigs its pixels come from. Returns false if the renderer cannot.
    virtual bool note_origins(bool noted) { return !noted; }
    /// Returns the sources of the last image; null if they were not recorded. Valid until the next
    /// call.
    virtual const PixelOrigins* origins() const { return nullptr; }

    /// Returns the depth of the last image along the camera's axis, r32f, in metres: 0 where there
    /// is nothing, and the sign has no meaning. Null: the renderer has none. Valid until the next
    /// call.
    virtual const Texture* depth_m() const { return nullptr; }

    /// Returns a sentence that says what the instant lacks for this view and how to mend it; empty
    /// if it lacks nothing. A view that is rendered all the same is black and not covered.
    virtual std::string lacks(const Instant& /*instant*/, const VirtualView& /*view*/) const {
        return {};
    }
};

/// A registered synthesiser: NAME_synthesiser.cpp in host_app/fused, points or gallery defines
/// NAME_synthesiser_entry().
struct SynthesiserEntry {
    std::string name;
    std::string summary;
    std::function<std::unique_ptr<InstantPreparer>(const ShaderLibrary&)> make_preparer;
    std::function<std::unique_ptr<ViewRenderer>(const ShaderLibrary&)> make_renderer;
    bool tells_origins = true;  ///< it reports which rigs its pixels come from
    bool needs_depth = true;    ///< at least one view must have depth
    std::vector<SynthesiserOption> options = {};
    /// For synthesisers with options: find_synthesiser() makes make_renderer from it.
    std::function<std::unique_ptr<ViewRenderer>(const ShaderLibrary&, const SynthesiserChoices&)>
        make_renderer_with = {};
};
/// Returns the product's own synthesisers.
std::vector<SynthesiserEntry> synthesiser_entries();
/// Returns the gallery's historic synthesisers, which run on the same input
/// (docs/develop/gallery.md).
std::vector<SynthesiserEntry> gallery_entries();
/// Returns the names, summaries and options of all synthesisers, for the help.
std::string synthesisers_help();

/// The synthesiser that is used unless another one is chosen.
inline constexpr const char* default_synthesiser = "fused";

/// Returns all names as the type of an option: "{fused,points} or gallery {mesh}".
std::string synthesisers_type_name();

/// Finds a synthesiser by "NAME" or "NAME:OPTION=VALUE,...", which becomes the entry's name. Throws
/// Error, which lists the known names or options, if there is none.
SynthesiserEntry find_synthesiser(const std::string& name);

/// Prepares and renders on one context at the best level, for images that need not be live.
class Synthesiser {
  public:
    Synthesiser(const SynthesiserEntry& entry, const ShaderLibrary& library)
        : preparer_(entry.make_preparer(library)), renderer_(entry.make_renderer(library)) {}

    /// Takes the next instant's views, as InstantPreparer::take().
    void set_views(std::span<const DepthView> views, double dt_s = 1.0 / 30) {
        preparer_->take(views, dt_s);
    }
    void cut() { preparer_->cut(); }
    /// Renders as ViewRenderer::render() does. Throws Error if the instant lacks something for it.
    const Texture& render(const VirtualView& view);
    /// Prepares and renders an instant that later ones build upon. One that lacks something for a
    /// picture, such as silhouettes before the background is known, is only prepared.
    void render_earlier(const VirtualView& view);
    bool note_origins(bool noted) { return renderer_->note_origins(noted); }
    const PixelOrigins* origins() const { return renderer_->origins(); }

  private:
    std::unique_ptr<InstantPreparer> preparer_;
    std::unique_ptr<ViewRenderer> renderer_;
    std::shared_ptr<const Instant> instant_;  ///< that was rendered last
};

/// Makes the synthesiser of this name. Throws Error as find_synthesiser() does.
std::unique_ptr<Synthesiser> make_synthesiser(const std::string& name,
                                              const ShaderLibrary& library);

}  // namespace vantage
