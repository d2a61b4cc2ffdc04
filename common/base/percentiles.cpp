#include "common/base/percentiles.h"

#include <algorithm>
#include <cmath>

namespace vantage {

PercentileRecorder::PercentileRecorder(std::size_t capacity)
    : capacity_(std::max<std::size_t>(capacity, 1)) {
    ring_.reserve(capacity_);
}

void PercentileRecorder::add(double sample) {
    if (ring_.size() < capacity_)
        ring_.push_back(sample);
    else
        ring_[count_ % capacity_] = sample;
    max_ = count_ == 0 ? sample : std::max(max_, sample);
    ++count_;
}

Percentiles PercentileRecorder::summary() const {
    Percentiles result;
    result.count = count_;
    if (ring_.empty()) return result;
    std::vector<double> sorted = ring_;
    std::sort(sorted.begin(), sorted.end());
    const auto at = [&](double fraction) {
        return sorted[static_cast<std::size_t>(
            std::lround(fraction * static_cast<double>(sorted.size() - 1)))];
    };
    result.p50 = at(0.50);
    result.p95 = at(0.95);
    result.p99 = at(0.99);
    result.max = max_;
    return result;
}

}  // namespace vantage
