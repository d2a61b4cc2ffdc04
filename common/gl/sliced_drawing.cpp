#include "common/gl/sliced_drawing.h"

#include <algorithm>
#include <cmath>

#include <GLES3/gl31.h>

#include "common/base/time.h"
#include "common/gl/fence.h"

namespace vantage {
namespace {

/// Like the current context, it belongs to the thread.
thread_local const SlicedDrawing* current_slicing = nullptr;

constexpr int first_rows = 32, fewest_rows = 8;
/// A driver that does not answer for so long is lost, not slow.
constexpr std::chrono::seconds patience{10};
/// A band waits so long for others at most, so that a renderer that is never done leaves some time.
constexpr std::chrono::milliseconds longest_way{60};

struct ScissorTest {
    ScissorTest() { glEnable(GL_SCISSOR_TEST); }
    ~ScissorTest() { glDisable(GL_SCISSOR_TEST); }
    ScissorTest(const ScissorTest&) = delete;
    ScissorTest& operator=(const ScissorTest&) = delete;
};

}  // namespace

SlicedDrawing::SlicedDrawing(std::chrono::nanoseconds slice, RightOfWay* way,
                             std::function<void()> between)
    : slice_(slice), way_(way), between_(std::move(between)), before_(current_slicing) {
    current_slicing = this;
}

SlicedDrawing::~SlicedDrawing() { current_slicing = before_; }

const SlicedDrawing* SlicedDrawing::current() { return current_slicing; }

void SlicedDrawing::give_way() const {
    if (way_) way_->give_way(longest_way);
    if (between_) between_();
}

void SlicedDrawing::draw(cv::Size target, int& rows, const std::function<void()>& draw) const {
    if (rows == 0) rows = first_rows;
    const ScissorTest scissor;
    for (int y = 0; y < target.height;) {
        const int height = std::min(rows, target.height - y);
        give_way();
        const MonotonicTime start = MonotonicClock::now();
        glScissor(0, y, target.width, height);
        draw();
        (void)Fence::insert().reached_within(patience);
        const double share = std::chrono::duration<double>(MonotonicClock::now() - start) /
                             std::chrono::duration<double>(slice_);
        y += height;
        // Halfway to what would have filled the slice: one band says little.
        const double fitting = height / std::max(share, 0.05);
        rows = std::clamp(static_cast<int>(std::lround(0.5 * (rows + fitting))), fewest_rows,
                          std::max(target.height, fewest_rows));
    }
}

}  // namespace vantage
