#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "common/base/time/time.h"
#include "common/gl/context/context_group.h"
#include "common/gl/context/render_priority.h"
#include "common/image/image.h"
#include "host_app/flight/camera_state.h"
#include "host_app/pipeline/instant_thread.h"
#include "host_app/programme/view_painter.h"

namespace vantage {

/// What the programme wants a picture of.
struct PictureJob {
    std::shared_ptr<const ReadyInstant> instant;
    CameraState camera;
    RenderLevel level;
    bool source_map = false;  ///< also which rigs its pixels come from
    std::uint64_t look = 0;   ///< of the programme, that the camera is of
};

/// Whether a picture of one would be that of the other.
bool is_same_picture(const PictureJob& a, const PictureJob& b);

/// A picture of the virtual camera. Immutable.
struct MadePicture {
    PictureJob job;
    ColourImage picture;               ///< rgba8 of the programme's size
    std::optional<SourceMap> sources;  ///< where it was wanted
    cv::Mat1f inverse_depth;           ///< as of CoarseDepth; empty: not known
    double render_ms = 0, readback_ms = 0;
    double make_ms = 0;  ///< from start() on: those, and what it waited for
    /// Of a reprojection: what it was carried on from; its job is that one's but for camera and
    /// look. Null: it was rendered itself.
    std::shared_ptr<const MadePicture> rendered;
};

/// Renders on a thread and a context of its own, one picture at a time, so that the programme's
/// clock waits for neither GPU nor compiler. A fault is logged, and everything is made anew; so it
/// is when the GPU was reset, and instants of before give no picture.
class PictureMaker {
  public:
    enum class Manner {
        at_once,    ///< with the right of way
        in_slices,  ///< gives way to others: for pictures that may take long
    };
    /// `contexts` and `way` must outlive the maker. Compiles at once; is_idle() tells when it is
    /// done.
    PictureMaker(SynthesiserEntry synthesiser, PictureFormat format, ContextGroup& contexts,
                 RenderPriority& way, Manner manner = Manner::at_once);
    ~PictureMaker();
    PictureMaker(const PictureMaker&) = delete;
    PictureMaker& operator=(const PictureMaker&) = delete;

    const std::string& synthesiser() const { return synthesiser_.name; }
    /// It can begin a picture now.
    bool is_idle() const;
    /// Precondition: is_idle().
    void start(PictureJob job);
    /// Makes pictures of the job at all levels, which nobody gets: see InstantPreparer::rehearse().
    /// Precondition: is_idle().
    void warm_up(PictureJob job);
    /// In slices: waits between two of them, for as long as this is so.
    void pause(bool is_paused);
    /// What was finished since the last call.
    std::shared_ptr<const MadePicture> take_finished();
    /// Times that everything was made anew after a fault.
    int faults() const;

  private:
    struct Work {
        PictureJob job;
        bool is_warm_up = false;
    };

    void run();
    void wait_while_paused();
    void make_pictures(const ContextGroup::Member& member);
    /// Waits for it, and claims the way for what is made at once; nothing at the end. Throws
    /// ContextLost if this generation of contexts is.
    std::optional<Work> next_work(std::uint64_t generation,
                                  std::optional<RenderPriority::Claim>& claim);
    std::shared_ptr<MadePicture> made(ViewPainter& painter, const PictureJob& job) const;

    SynthesiserEntry synthesiser_;
    PictureFormat format_;
    ContextGroup* contexts_;
    RenderPriority* way_;
    Manner manner_;
    mutable std::mutex mutex_;
    std::condition_variable woken_;
    std::optional<PictureJob> job_;
    MonotonicTime started_{};
    bool is_ready_ = false, is_stopping_ = false, is_paused_ = false, is_warm_up_ = false;
    std::shared_ptr<const MadePicture> finished_;
    int faults_ = 0;
    std::thread thread_;
};

}  // namespace vantage
