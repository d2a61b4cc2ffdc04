#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

#include "common/base/time/time.h"

namespace vantage {

/// Pairs the frames of two sensors whose times are less than half a period apart. It never pairs by
/// arrival or number, since one camera may start later, lose frames or deliver them in bursts. A
/// frame whose partner cannot arrive any more is counted and dropped. Holds at most a few frames
/// per side.
template <class Picture>
class FramePairer {
  public:
    struct Item {
        MonotonicTime time{};
        Picture picture;
    };
    struct Pair {
        Item left, right;
    };

    explicit FramePairer(std::chrono::nanoseconds period) : tolerance_(period / 2) {}

    void push_left(MonotonicTime time, Picture picture) { push(left_, time, std::move(picture)); }
    void push_right(MonotonicTime time, Picture picture) { push(right_, time, std::move(picture)); }

    /// Removes and returns the oldest complete pair; empty if there is none.
    std::optional<Pair> pop() {
        while (!left_.empty() && !right_.empty()) {
            const auto apart = left_.front().time - right_.front().time;
            if (apart < tolerance_ && -apart < tolerance_) {
                Pair pair{std::move(left_.front()), std::move(right_.front())};
                left_.pop_front();
                right_.pop_front();
                return pair;
            }
            auto& older = apart < std::chrono::nanoseconds(0) ? left_ : right_;
            older.pop_front();
            ++unpaired_;
        }
        return std::nullopt;
    }

    /// Drops the waiting frames, as after a sensor was lost.
    void clear() {
        unpaired_ += left_.size() + right_.size();
        left_.clear();
        right_.clear();
    }

    /// Number of frames that were dropped without a partner.
    std::uint64_t unpaired() const { return unpaired_; }

  private:
    static constexpr std::size_t capacity = 4;

    void push(std::deque<Item>& side, MonotonicTime time, Picture picture) {
        if (side.size() == capacity) {
            side.pop_front();
            ++unpaired_;
        }
        side.push_back({time, std::move(picture)});
    }

    std::chrono::nanoseconds tolerance_;
    std::deque<Item> left_, right_;
    std::uint64_t unpaired_ = 0;
};

}  // namespace vantage
