#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "host_app/flight/orbit_view.h"
#include "host_app/programme/governor.h"
#include "host_app/programme/picture_maker.h"

namespace vantage {

/// Renders frames of the camera on preview, from the programme's instants and in the time that the
/// programme leaves over. Its own renderer gives way to the programme's, starts only while that is
/// idle, and takes at most a share of the time. Used on the programme's thread, which never waits
/// for it.
class Preview {
  public:
    /// Frames have half the width and height of the programme's, and one eye.
    Preview(const PictureFormat& programme, double rate_hz, ContextGroup& contexts,
            RenderPriority& priority);

    /// To be called at every tick. `view` is empty if there is no camera on preview, and `instant`
    /// is null before the first. `may_begin`: the programme's renderer is idle.
    void follow(const std::optional<OrbitView>& view, const SynthesiserEntry& synthesiser,
                const std::shared_ptr<const ReadyInstant>& instant, bool may_begin,
                MonotonicTime now);
    /// Stops in the middle of a frame, or goes on.
    void pause(bool is_paused);
    /// Waits for the frame in work and ends the renderers.
    void end();

    /// Null before the first frame, and if there is no camera on preview.
    std::shared_ptr<const MadePicture> picture() const { return shown_; }
    std::uint64_t pictures() const { return pictures_; }
    /// Time of the last frame, with its waits for the programme.
    double last_make_ms() const { return last_make_ms_; }

  private:
    void take_finished(MonotonicTime now);

    PictureFormat format_;
    double tick_ms_;
    ContextGroup* contexts_;
    RenderPriority* priority_;
    LevelChooser level_;
    std::map<std::string, std::unique_ptr<PictureMaker>> makers_;  ///< by name of the synthesiser
    PictureMaker* maker_ = nullptr;                                ///< in use; null: none so far
    std::optional<PictureJob> begun_;
    bool is_under_way_ = false;
    MonotonicTime began_{}, next_{};
    std::shared_ptr<const MadePicture> shown_;
    std::uint64_t pictures_ = 0;
    double last_make_ms_ = 0;
};

}  // namespace vantage
