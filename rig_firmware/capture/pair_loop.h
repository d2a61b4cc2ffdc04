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

/// Cache of the image pairs of a repeating scene. A pair is shown again one loop later, identical
/// to the bit and without noise. All memory is allocated at the start; pairs that do not fit are
/// rendered every time.
class PairLoop {
  public:
    /// Caches as many pairs as fit into `most_bytes`, at most one loop. Caches nothing if the loop
    /// is not a whole number of pulses, since then no time repeats.
    PairLoop(cv::Size size, std::chrono::seconds loop, const PulseGrid& pulses,
             std::size_t most_bytes);

    struct Pair {
        ColourImage left, right;
    };
    /// Cached pair of this time, or of a time that is whole loops away; empty if there is none.
    std::optional<Pair> find(std::chrono::nanoseconds time) const;
    /// Caches a pair of opaque images.
    void keep(std::chrono::nanoseconds time, const ColourImage& left, const ColourImage& right);

    std::size_t length() const { return length_; }  ///< pairs per loop; 0 if no time repeats
    std::size_t room() const { return room_; }      ///< capacity in pairs
    std::size_t kept() const { return places_.size(); }

  private:
    std::chrono::nanoseconds folded(std::chrono::nanoseconds time) const;
    cv::Mat3b place(std::size_t pair, int side) const;

    cv::Size size_;
    std::chrono::nanoseconds loop_;
    std::size_t length_ = 0, room_ = 0;
    mutable std::vector<std::uint8_t> bytes_;  ///< RGB, left and right, one pair after another
    std::unordered_map<std::int64_t, std::size_t> places_;
};

}  // namespace vantage
