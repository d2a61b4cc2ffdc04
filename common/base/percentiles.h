#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vantage {

struct Percentiles {
    std::uint64_t count = 0;  ///< all samples ever added
    double p50 = 0, p95 = 0, p99 = 0, max = 0;
};

/// Collects samples (any unit) in a ring of bounded size: percentiles speak of the newest
/// `capacity` samples, count and max of all. A summary costs next to nothing, since a desk asks for
/// many of them at every picture of its own. Not thread-safe.
class PercentileRecorder {
  public:
    explicit PercentileRecorder(std::size_t capacity = 4096);
    /// What is no number is left out.
    void add(double sample);
    Percentiles summary() const;

  private:
    std::vector<double> ring_;
    std::vector<double> sorted_;  ///< the same samples
    std::size_t capacity_;
    std::uint64_t count_ = 0;
    double max_ = 0;
};

}  // namespace vantage
