#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "common/base/time/pulse_grid.h"
#include "common/image/image.h"

namespace vantage {

/// Picture pairs of a scene that repeats, kept as they are made and shown again a loop later: to
/// the bit, without their noise. All memory is taken at the start, so that it does not grow; pairs
/// that it has no room for are made every time.
class PairLoop {
  public:
    /// `most_bytes` hold as many pairs as fit, no more than a loop has. Nothing is kept where a
    /// loop is no whole number of pulses, for then no time of it comes twice.
    PairLoop(cv::Size size, std::chrono::seconds loop, const PulseGrid& pulses,
             std::size_t most_bytes);

    struct Pair {
        ColourImage left, right;
    };
    /// What was kept of this time, or of one whole loops away.
    std::optional<Pair> find(std::chrono::nanoseconds time) const;
    /// Its pictures are opaque.
    void keep(std::chrono::nanoseconds time, const ColourImage& left, const ColourImage& right);

    std::size_t length() const { return length_; }  ///< pairs of the loop; 0: no time comes twice
    std::size_t room() const { return room_; }      ///< pairs
    std::size_t kept() const { return places_.size(); }

  private:
    std::chrono::nanoseconds folded(std::chrono::nanoseconds time) const;
    cv::Mat3b place(std::size_t pair, int side) const;

    cv::Size size_;
    std::chrono::nanoseconds loop_;
    std::size_t length_ = 0, room_ = 0;
    mutable std::vector<std::uint8_t> bytes_;  ///< RGB, left and right, pair after pair
    std::unordered_map<std::int64_t, std::size_t> places_;
};

}  // namespace vantage
