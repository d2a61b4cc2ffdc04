#pragma once

#include <chrono>
#include <functional>
#include <optional>

#include <GLES3/gl31.h>

#include "common/gl/objects/gl_handle.h"

namespace vantage {

void delete_timer_query(GLuint name);

/// Times GPU work between begin() and end(), with EXT_disjoint_timer_query on GPUs that have it,
/// otherwise by waiting for the GPU at both ends. One timer times one span at a time; spans of
/// several timers must not nest, which the extension forbids.
class GpuTimer {
  public:
    GpuTimer();

    /// Whether timer queries are used. If not, begin() and end() wait for the GPU.
    bool is_of_gpu() const { return uses_queries_; }

    void begin();
    void end();
    /// Milliseconds of the last span, or of the one before if the GPU's clock was disturbed. Waits
    /// until the GPU has finished it.
    double wait_ms();
    /// The same without waiting: empty before any span and until the GPU has finished it.
    std::optional<double> poll_ms();

  private:
    bool uses_queries_;
    bool pending_ = false;
    GlHandle<delete_timer_query> query_;
    std::chrono::steady_clock::time_point begin_time_{};
    double last_ms_ = 0;
};

/// The median GPU time of `work` in ms over `repeats` runs (at least 1), waiting for each.
double median_gpu_ms(int repeats, const std::function<void()>& work);

}  // namespace vantage
