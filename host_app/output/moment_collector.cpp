#include "host_app/output/moment_collector.h"

#include <algorithm>

namespace vantage {

void MomentCollector::add(Moment moment) {
    kept_.push_back(std::move(moment));
    if (kept_.size() < 2 * wanted_ + 1) return;
    // With twice the stride, the next wanted frame follows the last even index.
    std::vector<Moment> even;
    for (std::size_t i = 0; i < kept_.size(); i += 2) even.push_back(std::move(kept_[i]));
    kept_ = std::move(even);
    stride_ *= 2;
}

std::vector<Moment> MomentCollector::chosen() const {
    if (kept_.size() <= wanted_) return kept_;
    std::vector<Moment> moments;
    for (std::size_t i = 0; i < wanted_; ++i) {
        // Rounded to the nearest evenly spaced index.
        const std::size_t place = (2 * i * (kept_.size() - 1) + wanted_ - 1) / (2 * (wanted_ - 1));
        moments.push_back(kept_[place]);
    }
    return moments;
}

}  // namespace vantage
