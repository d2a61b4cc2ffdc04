#pragma once

#include <chrono>
#include <functional>

#include <opencv2/core.hpp>

#include "common/gl/context/render_priority.h"

namespace vantage {

/// While it lives, fullscreen passes of this thread are drawn in bands of rows, each waited for
/// before the next is begun, so that another context that shares the GPU (or the software
/// rasteriser) gets its turn between them: while that one claims the right of way, bands wait. How
/// many rows a band has follows from what the bands of the same pass took before. `between` is
/// called before every band; what it throws ends the pass there.
class SlicedDrawing {
  public:
    /// `way` must outlive it; null: nobody goes first. Bands wait for others so long at most that
    /// `least_share` of the time is theirs, from 0 to 1.
    explicit SlicedDrawing(std::chrono::nanoseconds slice, RenderPriority* way = nullptr,
                           std::function<void()> between = {}, double least_share = 0);
    ~SlicedDrawing();
    SlicedDrawing(const SlicedDrawing&) = delete;
    SlicedDrawing& operator=(const SlicedDrawing&) = delete;

    /// Of this thread; null: nothing is to be sliced.
    static const SlicedDrawing* current();

    /// Calls `draw` under a scissor for every band of the target. `rows` is the pass's own memory
    /// of a band's height; 0 at first.
    void draw(cv::Size target, int& rows, const std::function<void()>& draw) const;
    /// Waits while another context has the right of way, not for ever. Throws what `between` does.
    void give_way() const;

  private:
    void drew_for(std::chrono::nanoseconds time) const;

    std::chrono::nanoseconds slice_;
    RenderPriority* way_;
    std::function<void()> between_;
    double least_share_;
    mutable std::chrono::nanoseconds may_wait_;  ///< by what was drawn; a thread's own
    const SlicedDrawing* before_;
};

}  // namespace vantage
