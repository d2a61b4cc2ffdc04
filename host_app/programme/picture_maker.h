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

/// A frame to be rendered.
struct PictureJob {
    std::shared_ptr<const ReadyInstant> instant;
    CameraState camera;
    RenderLevel level;
    bool source_map = false;  ///< render the source map as well
    std::uint64_t step = 0;   ///< number of the programme's step that gave the camera
};

/// Whether both jobs give the same frame.
bool is_same_picture(const PictureJob& a, const PictureJob& b);

/// A rendered frame of the virtual camera. Immutable.
struct MadePicture {
    PictureJob job;
    ColourImage picture;               ///< rgba8, of the programme's size
    std::optional<SourceMap> sources;  ///< if the job asked for it
    cv::Mat1f inverse_depth;           ///< see CoarseDepth; empty: not known
    double render_ms = 0, readback_ms = 0;
    double make_ms = 0;  ///< from start() to the finished frame, with all waits
    /// The frame that this one was reprojected from, null if it was rendered. Their jobs differ in
    /// camera and step.
    std::shared_ptr<const MadePicture> rendered;
};

/// Renders frames on its own thread and GL context, one at a time, so that the programme's clock
/// waits neither for the GPU nor for the shader compiler. After a fault, which is logged, and after
/// a GPU reset the renderer is recreated; jobs with instants from before a reset are dropped.
/// Thread-safe.
class PictureMaker {
  public:
    enum class Manner {
        at_once,    ///< with render priority
        in_slices,  ///< gives way to other work between slices; for frames that may take long
    };
    /// `contexts` and `priority` must outlive the maker. It starts to compile at once and is idle
    /// when that is done.
    PictureMaker(SynthesiserEntry synthesiser, PictureFormat format, ContextGroup& contexts,
                 RenderPriority& priority, Manner manner = Manner::at_once);
    ~PictureMaker();
    PictureMaker(const PictureMaker&) = delete;
    PictureMaker& operator=(const PictureMaker&) = delete;

    const std::string& synthesiser() const { return synthesiser_.name; }
    /// Whether it can start a frame.
    bool is_idle() const;
    /// Precondition: is_idle().
    void start(PictureJob job);
    /// Renders the job at all levels and discards the frames; see InstantPreparer::warm_up().
    /// Precondition: is_idle().
    void warm_up(PictureJob job);
    /// With Manner::in_slices: stops between two slices, or goes on.
    void pause(bool is_paused);
    /// The frame that was finished since the last call; null: none.
    std::shared_ptr<const MadePicture> take_finished();
    /// Number of times that the renderer was recreated after a fault.
    int faults() const;

  private:
    struct Work {
        PictureJob job;
        bool is_warm_up = false;
    };

    void run();
    void wait_while_paused();
    void make_pictures(const ContextGroup::Member& member);
    /// Waits for a job and claims render priority for Manner::at_once. Empty when the maker ends.
    /// Throws ContextLost if this generation of contexts was lost.
    std::optional<Work> next_work(std::uint64_t generation,
                                  std::optional<RenderPriority::Claim>& claim);
    std::shared_ptr<MadePicture> rendered(ViewPainter& painter, const PictureJob& job) const;

    SynthesiserEntry synthesiser_;
    PictureFormat format_;
    ContextGroup* contexts_;
    RenderPriority* priority_;
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
