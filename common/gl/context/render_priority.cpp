#include "common/gl/context/render_priority.h"

namespace vantage {

RightOfWay::Claim::Claim(RightOfWay& way) : way_(&way) {
    const std::lock_guard lock(way_->mutex_);
    ++way_->claims_;
}

RightOfWay::Claim::~Claim() {
    {
        const std::lock_guard lock(way_->mutex_);
        --way_->claims_;
    }
    way_->freed_.notify_all();
}

void RightOfWay::give_way(std::chrono::nanoseconds longest) {
    std::unique_lock lock(mutex_);
    freed_.wait_for(lock, longest, [&] { return claims_ == 0; });
}

}  // namespace vantage
