#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace vantage {

/// A thread-safe queue of bounded capacity between two threads. When the queue is full, push()
/// drops the OLDEST item and counts it. close() wakes the reader, which can still pop the items
/// that were pushed before.
template <class T>
class BoundedQueue {
  public:
    explicit BoundedQueue(std::size_t capacity) : capacity_(capacity > 0 ? capacity : 1) {}

    /// Adds an item; returns the item that was dropped to make room, if any.
    std::optional<T> push(T item) {
        std::optional<T> dropped;
        {
            const std::lock_guard lock(mutex_);
            if (closed_) return item;
            if (items_.size() == capacity_) {
                dropped = std::move(items_.front());
                items_.pop_front();
                ++dropped_count_;
            }
            items_.push_back(std::move(item));
        }
        ready_.notify_one();
        return dropped;
    }

    /// Waits for an item. Empty after the timeout, or once the queue is closed and drained.
    std::optional<T> pop_for(std::chrono::nanoseconds timeout) {
        std::unique_lock lock(mutex_);
        ready_.wait_for(lock, timeout, [&] { return closed_ || !items_.empty(); });
        if (items_.empty()) return std::nullopt;
        T item = std::move(items_.front());
        items_.pop_front();
        lock.unlock();
        room_.notify_one();
        return item;
    }

    /// Waits until a push would drop nothing. False after the timeout, or when the queue is closed.
    bool wait_for_room(std::chrono::nanoseconds timeout) {
        std::unique_lock lock(mutex_);
        return room_.wait_for(lock, timeout, [&] {
            return closed_ || items_.size() < capacity_;
        }) && !closed_;
    }

    void close() {
        {
            const std::lock_guard lock(mutex_);
            closed_ = true;
        }
        ready_.notify_all();
        room_.notify_all();
    }

    bool closed() const {
        const std::lock_guard lock(mutex_);
        return closed_;
    }
    std::size_t size() const {
        const std::lock_guard lock(mutex_);
        return items_.size();
    }
    std::uint64_t dropped_count() const {
        const std::lock_guard lock(mutex_);
        return dropped_count_;
    }

  private:
    mutable std::mutex mutex_;
    std::condition_variable ready_, room_;
    std::deque<T> items_;
    std::size_t capacity_;
    std::uint64_t dropped_count_ = 0;
    bool closed_ = false;
};

}  // namespace vantage
