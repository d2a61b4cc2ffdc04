#include "common/gl/driver_turn.h"

#include <cassert>
#include <utility>

namespace vantage {
namespace {

/// Like the current context, it belongs to the thread.
thread_local std::mutex* held = nullptr;

}  // namespace

DriverTurn::DriverTurn(std::mutex* driver) : driver_(driver) {
    assert(!held);
    if (!driver_) return;
    driver_->lock();
    held = driver_;
}

DriverTurn::~DriverTurn() {
    if (!driver_) return;
    held = nullptr;
    driver_->unlock();
}

DriverTurn::Pause::Pause() : driver_(std::exchange(held, nullptr)) {
    if (driver_) driver_->unlock();
}

DriverTurn::Pause::~Pause() {
    if (!driver_) return;
    driver_->lock();
    held = driver_;
}

}  // namespace vantage
