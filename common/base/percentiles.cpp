#include "common/base/percentiles.h"

#include <algorithm>
#include <cmath>

namespace vantage {

PercentileRecorder::PercentileRecorder(std::size_t capacity)
    : capacity_(std::max<std::size_t>(capacity, 1)) {
    ring_.reserve(capacity_);
    sorted_.reserve(capacity_);
}

void PercentileRecorder::add(double sample) {
    if (std::isnan(sample)) return;
    if (ring_.size() < capacity_) {
        ring_.push_back(sample);
    } else {
        double& oldest = ring_[count_ % capacity_];
        sorted_.erase(std::lower_bound(sorted_.begin(), sorted_.end(), oldest));
        oldest = sample;
    }
    sorted_.insert(std::upper_bound(sorted_.begin(), sorted_.end(), sample), sample);
    max_ = count_ == 0 ? sample : std::max(max_, sample);
    ++count_;
}

Percentiles PercentileRecorder::summary() const {
    Percentiles result;
    result.count = count_;
    if (sorted_.empty()) return result;
    const auto at = [&](double fraction) {
        return sorted_[static_cast<std::size_t>(
            std::lround(fraction * static_cast<double>(sorted_.size() - 1)))];
    };
    result.p50 = at(0.50);
    result.p95 = at(0.95);
    result.p99 = at(0.99);
    result.max = max_;
    return result;
}

}  // namespace vantage
