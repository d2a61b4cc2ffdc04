#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vantage::thesis {

/// Matching costs are 1/32 grey levels, capped: 10 bits.
inline constexpr int max_cost = 1023;

/// On the GPU a cost volume is a storage buffer of uvec4 elements, [slice][row][column], each with
/// the costs of eight neighbouring disparities in 16-bit halves: disparity 8 * slice + 2 * k + h is
/// half h (0 = low) of component k.
inline constexpr int disparities_per_slice = 8;
inline constexpr std::size_t bytes_per_element = 16;

constexpr int slices_for(int disparities) {
    return (disparities + disparities_per_slice - 1) / disparities_per_slice;
}

/// The same in plain form, for the CPU references: [disparity][row][column].
struct CostVolume {
    CostVolume(int width, int height, int disparity_count)
        : width_px(width),
          height_px(height),
          disparities(disparity_count),
          costs(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                static_cast<std::size_t>(disparity_count)) {}

    std::uint16_t& at(int d, int y, int x) { return costs[index(d, y, x)]; }
    std::uint16_t at(int d, int y, int x) const { return costs[index(d, y, x)]; }

    int width_px, height_px, disparities;
    std::vector<std::uint16_t> costs;

  private:
    std::size_t index(int d, int y, int x) const {
        return (static_cast<std::size_t>(d) * static_cast<std::size_t>(height_px) +
                static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(width_px) +
               static_cast<std::size_t>(x);
    }
};

}  // namespace vantage::thesis
