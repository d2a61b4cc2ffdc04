#include "host_app/output/screen_feed.h"

#include <utility>

#include "common/base/error.h"

namespace vantage {

ScreenFeed::State ScreenFeed::state() const {
    const std::lock_guard lock(mutex_);
    return state_;
}

void ScreenFeed::ask() {
    const std::lock_guard lock(mutex_);
    state_ = State::asked;
    picture_ = ColourImage();
}

void ScreenFeed::put(const ColourImage& picture) {
    const std::lock_guard lock(mutex_);
    if (state_ != State::shown) vantage::fail("{}", failure_);
    picture_ = picture;
}

void ScreenFeed::close() {
    const std::lock_guard lock(mutex_);
    state_ = State::closed;
    picture_ = ColourImage();
}

std::string ScreenFeed::failure() const {
    const std::lock_guard lock(mutex_);
    return failure_;
}

void ScreenFeed::show() {
    const std::lock_guard lock(mutex_);
    if (state_ == State::asked) state_ = State::shown;
}

void ScreenFeed::fail(const std::string& why) {
    const std::lock_guard lock(mutex_);
    if (state_ == State::closed) return;
    state_ = State::failed;
    failure_ = why;
}

ColourImage ScreenFeed::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(picture_, ColourImage());
}

}  // namespace vantage
