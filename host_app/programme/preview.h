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

/// Pictures of the camera on preview, of the instants that are there anyway and in the time that
/// the programme leaves over: a picture maker of its own gives way to the programme's, is begun
/// only while that rests, and takes no more than a share of the time. Off until it is asked for. Of
/// the programme's thread, which never waits for it.
class Preview {
  public:
    /// Pictures have half the width and height of the programme's, and one eye.
    Preview(const PictureFormat& programme, double rate_hz, ContextGroup& contexts,
            RenderPriority& way);

    /// To be called at every tick. `view`: what the camera on preview sees; nothing: there is none.
    /// `instant`: null before the first. `may_begin`: the programme rests.
    void follow(const std::optional<OrbitView>& view, const SynthesiserEntry& synthesiser,
                const std::shared_ptr<const ReadyInstant>& instant, bool may_begin,
                MonotonicTime now);
    /// In the middle of a picture: it waits, for as long as this is so.
    void pause(bool is_paused);
    /// Waits for what is under way.
    void end();

    /// Null: none yet, or there is no camera on preview.
    std::shared_ptr<const MadePicture> picture() const { return shown_; }
    std::uint64_t pictures() const { return pictures_; }
    /// What the last one took, waiting for the programme included.
    double last_make_ms() const { return last_make_ms_; }

  private:
    void take_finished(MonotonicTime now);

    PictureFormat format_;
    double tick_ms_;
    ContextGroup* contexts_;
    RenderPriority* way_;
    LevelChooser level_;
    std::map<std::string, std::unique_ptr<PictureMaker>> makers_;  ///< by synthesiser, kept
    PictureMaker* maker_ = nullptr;  ///< in use; null: it was never asked for
    std::optional<PictureJob> begun_;
    bool is_under_way_ = false;
    MonotonicTime began_{}, next_{};
    std::shared_ptr<const MadePicture> shown_;
    std::uint64_t pictures_ = 0;
    double last_make_ms_ = 0;
};

}  // namespace vantage
