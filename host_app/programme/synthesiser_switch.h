#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "host_app/pipeline/instant_thread.h"
#include "host_app/programme/picture_maker.h"

namespace vantage {

/// The renderer of the synthesiser in use, and the switch to the next one. Renderers of earlier
/// synthesisers are kept: drivers release little of what a renderer has allocated, and switching
/// back needs no compilation. Used on the programme's thread only.
class SynthesiserSwitch {
  public:
    /// `instants` must outlive this object.
    SynthesiserSwitch(const PictureFormat& format, InstantThread& instants,
                      const SynthesiserEntry& first);

    const SynthesiserEntry& synthesiser() const { return current_->synthesiser; }
    PictureMaker& maker() { return *current_->maker; }
    const PictureMaker& maker() const { return *current_->maker; }
    /// Whether an instant was prepared for the synthesiser in use.
    bool fits(const ReadyInstant* instant) const {
        return instant && instant->synthesiser == current_->synthesiser.name;
    }

    /// Starts to compile the next synthesiser, unless a switch is under way.
    void begin_next();
    /// Completes a switch once the renderer is compiled and the newest instant was prepared for it.
    /// True if the synthesiser in use has changed.
    bool follow(const ReadyInstant* newest);
    /// Number of times that a renderer was recreated.
    int faults() const;
    /// Ends all renderers.
    void end() { renderers_.clear(); }

  private:
    struct Renderer {
        SynthesiserEntry synthesiser;
        std::unique_ptr<PictureMaker> maker;
    };
    Renderer& renderer_of(const SynthesiserEntry& synthesiser);

    PictureFormat format_;
    InstantThread& instants_;
    std::map<std::string, Renderer> renderers_;  ///< by name of the synthesiser
    Renderer* current_;
    Renderer* next_ = nullptr;  ///< null: no switch is under way
};

/// Renders the frame at best quality while camera and instant stand still, in slices that give way
/// to all other work. Used on the programme's thread only.
class StillRefiner {
  public:
    /// `instants` must outlive this object.
    StillRefiner(const PictureFormat& format, InstantThread& instants)
        : format_(format), instants_(instants) {}

    /// Starts to render a job, unless it was started before or another one is being rendered.
    void refine(const SynthesiserEntry& synthesiser, const PictureJob& job);
    /// Stops between two slices, or goes on.
    void pause(bool is_paused);
    /// The frame that was finished since the last call; null: none.
    std::shared_ptr<const MadePicture> take_finished();
    /// Ends all renderers.
    void end();

  private:
    PictureFormat format_;
    InstantThread& instants_;
    std::map<std::string, std::unique_ptr<PictureMaker>> makers_;  ///< by name of the synthesiser
    PictureMaker* maker_ = nullptr;  ///< in use; null: nothing was refined yet
    std::optional<PictureJob> begun_;
};

}  // namespace vantage
