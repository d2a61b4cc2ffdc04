#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vantage {

struct Percentiles {
    std::uint64_t count = 0;  ///< of all samples ever added
    double p50 = 0, p95 = 0, p99 = 0, max = 0;
};

/// Computes percentiles of samples (any unit) from a ring of bounded size: percentiles cover the
/// newest `capacity` samples, count and maximum cover all. summary() is cheap, since the desk reads
/// many of them for every frame it draws. Not thread-safe.
class PercentileRecorder {
  public:
    explicit PercentileRecorder(std::size_t capacity = 4096);
    /// Ignores NaN.
    void add(double sample);
    Percentiles summary() const;

  private:
    std::vector<double> ring_;
    std::vector<double> sorted_;  ///< the samples of ring_ in ascending order
    std::size_t capacity_;
    std::uint64_t count_ = 0;
    double max_ = 0;
};

}  // namespace vantage
