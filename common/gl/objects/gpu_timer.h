#pragma once

#include <chrono>
#include <functional>
#include <optional>

#include <GLES3/gl31.h>

#include "common/gl/objects/gl_handle.h"

namespace vantage {

void delete_timer_query(GLuint name);

/// Times GPU work between begin() and end() with EXT_disjoint_timer_query where a GPU's driver has
/// it, else by waiting for the GPU at both ends and reading the clock. One timer times one span at
/// a time; spans of several timers must not nest (the extension allows one at a time).
class GpuTimer {
  public:
    GpuTimer();

    /// False: begin() and end() wait for the GPU.
    bool is_of_gpu() const { return uses_queries_; }

    void begin();
    void end();
    /// Milliseconds of the last span, or of the one before where the GPU's clock was disturbed;
    /// waits until the GPU has finished it.
    double wait_ms();
    /// The same without waiting: empty while the GPU is still at it (or before any span).
    std::optional<double> poll_ms();

  private:
    bool uses_queries_;
    bool pending_ = false;
    GlHandle<delete_timer_query> query_;
    std::chrono::steady_clock::time_point begin_time_{};
    double last_ms_ = 0;
};

/// Milliseconds that the GPU takes for the commands `work` issues: the median of `repeats` runs (at
/// least 1), each waited for.
double median_gpu_ms(int repeats, const std::function<void()>& work);

}  // namespace vantage
