#include "common/gl/context/render_priority.h"

namespace vantage {

RenderPriority::Claim::Claim(RenderPriority& way) : way_(&way) {
    const std::lock_guard lock(way_->mutex_);
    ++way_->claims_;
}

RenderPriority::Claim::~Claim() {
    {
        const std::lock_guard lock(way_->mutex_);
        --way_->claims_;
    }
    way_->freed_.notify_all();
}

void RenderPriority::give_way(std::chrono::nanoseconds longest) {
    std::unique_lock lock(mutex_);
    freed_.wait_for(lock, longest, [&] { return claims_ == 0; });
}

}  // namespace vantage
