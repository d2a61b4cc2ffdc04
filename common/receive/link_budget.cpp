#include "common/receive/link_budget.h"

#include <algorithm>
#include <functional>
#include <numeric>

namespace vantage {
namespace {

/// A full packet takes 1538 bytes on Ethernet for 1448 bytes of data; ZeroMQ and its encryption add
/// less than one percent.
constexpr double wire_bytes_a_byte = 1538.0 / 1448 * 1.01;
/// SRT needs this many times as much as TCP for the same frames: a further packet for each five,
/// and shorter packets (docs/build/networks.md).
constexpr double datagram_factor = 1.25;
constexpr double planned_share = 0.8;
/// The largest rate divisor that is proposed.
constexpr int most_divisor = 16;

double mbit_s(double bytes_a_frame, double rate_hz) {
    constexpr double bits_a_byte = 8, bits_a_mbit = 1e6;
    return bits_a_byte * wire_bytes_a_byte * bytes_a_frame * rate_hz / bits_a_mbit;
}

/// Returns the bytes per frame of a rig.
using BytesOf = std::function<double(const RigWeight&)>;

/// Bytes at a JPEG quality; unchanged for a quality that was not measured.
BytesOf at_quality(std::optional<int> quality) {
    return [quality](const RigWeight& weight) {
        double colour = weight.colour_bytes;
        for (const RigWeight::AtQuality& step : weight.ladder)
            if (step.quality == quality) colour = std::min(colour, step.colour_bytes);
        return colour + weight.other_bytes;
    };
}

/// Bytes at an image scale; unchanged for a scale that was not measured.
BytesOf at_scale(double scale) {
    return [scale](const RigWeight& weight) {
        for (const RigWeight::AtScale& step : weight.smaller)
            if (step.scale == scale)
                return step.colour_share * weight.colour_bytes + scale * scale * weight.other_bytes;
        return weight.colour_bytes + weight.other_bytes;
    };
}

/// `rigs`: the number of largest rigs that send at a time; 0: all.
LinkBudget budget_at(const std::vector<RigWeight>& weights, double rate_hz,
                     const LinkLimits& limits, const BytesOf& bytes_of, std::size_t rigs = 0) {
    LinkBudget budget;
    std::vector<double> sent;
    for (const RigWeight& weight : weights) {
        const double needed =
            (weight.by_datagrams ? datagram_factor : 1) * mbit_s(bytes_of(weight), rate_hz);
        budget.rigs.push_back({weight.rig, needed, needed / (planned_share * limits.rig_mbit_s)});
        sent.push_back(needed);
    }
    std::sort(sent.begin(), sent.end(), std::greater<>());
    if (rigs > 0 && rigs < sent.size()) sent.resize(rigs);
    budget.host_mbit_s = std::accumulate(sent.begin(), sent.end(), 0.0);
    budget.host_share = budget.host_mbit_s / (planned_share * limits.host_mbit_s);
    return budget;
}

}  // namespace

bool LinkBudget::fits() const {
    return host_share <= 1 &&
           std::all_of(rigs.begin(), rigs.end(), [](const Rig& rig) { return rig.share <= 1; });
}

LinkBudget plan_links(const std::vector<RigWeight>& weights, double rate_hz,
                      const LinkLimits& limits) {
    LinkBudget budget = budget_at(weights, rate_hz, limits, at_quality(std::nullopt));
    if (budget.fits() || weights.empty()) return budget;
    // Each divisor once, with the best quality that fits: a lower quality at a lower rate is
    // worse in both respects.
    std::vector<std::optional<int>> qualities{std::nullopt};
    for (const RigWeight::AtQuality& step : weights.front().ladder)
        qualities.emplace_back(step.quality);
    std::size_t coarsest = qualities.size();
    for (int divisor = 1; divisor <= most_divisor && coarsest > 0; ++divisor)
        for (std::size_t i = 0; i < coarsest; ++i) {
            const LinkBudget then =
                budget_at(weights, rate_hz / divisor, limits, at_quality(qualities[i]));
            if (!then.fits()) continue;
            budget.proposals.push_back({qualities[i], divisor, then.host_mbit_s});
            coarsest = i;
        }
    for (const RigWeight::AtScale& step : weights.front().smaller) {
        const LinkBudget then = budget_at(weights, rate_hz, limits, at_scale(step.scale));
        if (!then.fits()) continue;
        budget.proposals.push_back({.host_mbit_s = then.host_mbit_s, .scale = step.scale});
        break;
    }
    const std::size_t rigs = limits.programme_rigs;
    if (rigs > 0 && rigs < weights.size()) {
        const LinkBudget then = budget_at(weights, rate_hz, limits, at_quality(std::nullopt), rigs);
        if (then.fits())
            budget.proposals.push_back({.host_mbit_s = then.host_mbit_s, .rigs = rigs});
    }
    return budget;
}

}  // namespace vantage
