#pragma once

#include <chrono>
#include <functional>

#include <opencv2/core.hpp>

#include "common/gl/context/render_priority.h"

namespace vantage {

/// Draws fullscreen passes of this thread in bands of rows during its life, and waits for the GPU
/// after each band, so that another context on the same GPU or software rasteriser can draw between
/// them. While a RenderPriority is claimed, bands wait. The height of a band follows from the time
/// that earlier bands of the same pass took. `between` is called before each band; an exception
/// from it ends the pass.
class SlicedDrawing {
  public:
    /// `way` must outlive this object; null: no priorities. Bands wait for claims only so long that
    /// `least_share` of the time, from 0 to 1, stays for this thread.
    explicit SlicedDrawing(std::chrono::nanoseconds slice, RenderPriority* way = nullptr,
                           std::function<void()> between = {}, double least_share = 0);
    ~SlicedDrawing();
    SlicedDrawing(const SlicedDrawing&) = delete;
    SlicedDrawing& operator=(const SlicedDrawing&) = delete;

    /// The slicing of this thread; null if passes are drawn whole.
    static const SlicedDrawing* current();

    /// Calls `draw` under a scissor for each band of the target. `rows` keeps the band's height for
    /// the pass; 0 at first.
    void draw(cv::Size target, int& rows, const std::function<void()>& draw) const;
    /// Waits while another context has priority, within the limit. Throws what `between` throws.
    void give_way() const;

  private:
    void drew_for(std::chrono::nanoseconds time) const;

    std::chrono::nanoseconds slice_;
    RenderPriority* way_;
    std::function<void()> between_;
    double least_share_;
    mutable std::chrono::nanoseconds may_wait_;  ///< remaining wait, earned by drawing
    const SlicedDrawing* before_;
};

}  // namespace vantage
