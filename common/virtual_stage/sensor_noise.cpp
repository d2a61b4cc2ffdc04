#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "common/base/error.h"
#include "common/virtual_stage/virtual_rig.h"

namespace vantage {
namespace {

constexpr int quantile_bits = 12;
constexpr int quantiles = 1 << quantile_bits;
constexpr int fraction_bits = 8;

/// A 64-bit mixing function (SplitMix64; Steele, Lea, Flood 2014).
std::uint64_t mix(std::uint64_t x) {
    x += 0x9E3779B97F4A7C15u;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
}

/// Standard normal quantiles at (i + 1/2) / quantiles, by bisection of the distribution function.
std::array<float, quantiles> make_normal_quantiles() {
    std::array<float, quantiles> table{};
    for (int i = 0; i < quantiles / 2; ++i) {
        const double p = (i + 0.5) / quantiles;
        double low = -6, high = 0;
        for (int step = 0; step < 40; ++step) {
            const double middle = 0.5 * (low + high);
            (0.5 * std::erfc(-middle / std::sqrt(2.0)) < p ? low : high) = middle;
        }
        table[static_cast<std::size_t>(i)] = static_cast<float>(low);
        table[static_cast<std::size_t>(quantiles - 1 - i)] = static_cast<float>(-low);
    }
    return table;
}

}  // namespace

void add_sensor_noise(ColourImage& picture, const SensorNoise& noise, int side,
                      std::uint64_t frame_index) {
    if (noise.sigma == 0) return;
    if (!(noise.sigma > 0) || noise.sigma > 128)
        fail("sensor noise of {} grey levels: it must be 0 to 128", noise.sigma);
    static const std::array<float, quantiles> normal = make_normal_quantiles();
    // Fixed point reduces the inner loop to a table look-up, an addition and a clamp.
    std::vector<int> offsets(quantiles);
    for (std::size_t i = 0; i < offsets.size(); ++i)
        offsets[i] = static_cast<int>(
            std::lround(noise.sigma * static_cast<double>(normal[i]) * (1 << fraction_bits)));
    const std::uint64_t key =
        mix(mix(mix(noise.seed) + static_cast<std::uint64_t>(side)) + frame_index);
    constexpr unsigned mask = quantiles - 1;
    constexpr int half = 1 << (fraction_bits - 1);
    std::uint64_t counter = key;
    for (int y = 0; y < picture.rows; ++y) {
        cv::Vec4b* row = picture.ptr<cv::Vec4b>(y);
        for (int x = 0; x < picture.cols; ++x) {
            const std::uint64_t bits = mix(counter++);
            for (int channel = 0; channel < 3; ++channel) {
                const auto index =
                    static_cast<std::size_t>((bits >> (quantile_bits * channel)) & mask);
                const int value =
                    ((row[x][channel] << fraction_bits) + offsets[index] + half) >> fraction_bits;
                row[x][channel] = static_cast<unsigned char>(std::clamp(value, 0, 255));
            }
        }
    }
}

}  // namespace vantage
