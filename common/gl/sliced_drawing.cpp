#include "common/gl/sliced_drawing.h"

#include <algorithm>
#include <cmath>

#include <GLES3/gl31.h>

#include "common/base/time/time.h"
#include "common/base/trace/trace.h"
#include "common/gl/context/driver_lock.h"
#include "common/gl/objects/fence.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

/// Thread-local, like the current context.
thread_local const SlicedDrawing* current_slicing = nullptr;

/// The first band of a pass, and the smallest one, in rows.
constexpr int first_rows = 32, fewest_rows = 8;
/// The longest wait of a band for a priority renderer, so that one that is always busy leaves some
/// time to others.
constexpr std::chrono::milliseconds longest_way{60};

/// Restricts drawing to a range of rows during its life.
class ScissorRows {
  public:
    explicit ScissorRows(int width) : width_(width) { glEnable(GL_SCISSOR_TEST); }
    ~ScissorRows() { glDisable(GL_SCISSOR_TEST); }
    ScissorRows(const ScissorRows&) = delete;
    ScissorRows& operator=(const ScissorRows&) = delete;

    void keep(int first, int rows) const { glScissor(0, first, width_, rows); }

  private:
    int width_;
};

}  // namespace

SlicedDrawing::SlicedDrawing(std::chrono::nanoseconds slice, RenderPriority* way,
                             std::function<void()> between, double least_share)
    : slice_(slice),
      way_(way),
      between_(std::move(between)),
      least_share_(least_share),
      may_wait_(longest_way),
      before_(current_slicing) {
    current_slicing = this;
}

SlicedDrawing::~SlicedDrawing() { current_slicing = before_; }

const SlicedDrawing* SlicedDrawing::current() { return current_slicing; }

void SlicedDrawing::give_way() const {
    const DriverLock::Pause pause;
    if (way_) {
        TraceSpan span("give way");
        const MonotonicTime start = MonotonicClock::now();
        way_->give_way(may_wait_);
        span.end_unless_shorter(std::chrono::microseconds(100));
        if (least_share_ > 0)
            may_wait_ = std::max(may_wait_ - (MonotonicClock::now() - start), 0ns);
    }
    if (between_) between_();
}

void SlicedDrawing::drew_for(std::chrono::nanoseconds time) const {
    if (least_share_ <= 0) return;
    const std::chrono::duration<double> earned = time * (1 / least_share_ - 1);
    may_wait_ = std::min<std::chrono::nanoseconds>(
        may_wait_ + std::chrono::duration_cast<std::chrono::nanoseconds>(earned), longest_way);
}

void SlicedDrawing::draw(cv::Size target, int& rows, const std::function<void()>& draw) const {
    const ScissorRows scissor(target.width);
    if (rows == 0) rows = first_rows;
    for (int y = 0; y < target.height;) {
        const int height = std::min(rows, target.height - y);
        give_way();
        const MonotonicTime start = MonotonicClock::now();
        scissor.keep(y, height);
        draw();
        Fence::insert().wait("a part of a picture was drawn");
        const std::chrono::nanoseconds time = MonotonicClock::now() - start;
        drew_for(time);
        const double share =
            std::chrono::duration<double>(time) / std::chrono::duration<double>(slice_);
        y += height;
        // Halfway to the height that would have filled the slice, since one band's time is noisy.
        const double fitting = height / std::max(share, 0.05);
        rows = std::clamp(static_cast<int>(std::lround(0.5 * (rows + fitting))), fewest_rows,
                          std::max(target.height, fewest_rows));
    }
}

}  // namespace vantage
