#include "common/receive/link_budget.h"

#include <algorithm>

namespace vantage {
namespace {

/// Of 1538 bytes that a full packet takes on Ethernet 1448 are the sender's; ZeroMQ and its
/// encryption add less than a hundredth.
constexpr double wire_bytes_a_byte = 1538.0 / 1448 * 1.01;
constexpr double planned_share = 0.8;
/// A host may ask a rig for no fewer.
constexpr int most_divisor = 16;

double mbit_s(double bytes_a_frame, double rate_hz) {
    constexpr double bits_a_byte = 8, bits_a_mbit = 1e6;
    return bits_a_byte * wire_bytes_a_byte * bytes_a_frame * rate_hz / bits_a_mbit;
}

/// Of one frame; of a quality that the ladder lacks, as it is.
double bytes_at(const RigWeight& weight, std::optional<int> quality) {
    double colour = weight.colour_bytes;
    for (const RigWeight::AtQuality& step : weight.ladder)
        if (step.quality == quality) colour = std::min(colour, step.colour_bytes);
    return colour + weight.other_bytes;
}

LinkBudget budget_at(const std::vector<RigWeight>& weights, double rate_hz,
                     const LinkLimits& limits, std::optional<int> quality) {
    LinkBudget budget;
    for (const RigWeight& weight : weights) {
        const double needed = mbit_s(bytes_at(weight, quality), rate_hz);
        budget.rigs.push_back({weight.rig, needed, needed / (planned_share * limits.rig_mbit_s)});
        budget.host_mbit_s += needed;
    }
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
    LinkBudget budget = budget_at(weights, rate_hz, limits, std::nullopt);
    if (budget.fits() || weights.empty()) return budget;
    // Each divisor once, with the best quality that fits it; a coarser one at a lower rate is worse
    // in both.
    std::vector<std::optional<int>> qualities{std::nullopt};
    for (const RigWeight::AtQuality& step : weights.front().ladder)
        qualities.emplace_back(step.quality);
    std::size_t coarsest = qualities.size();
    for (int divisor = 1; divisor <= most_divisor && coarsest > 0; ++divisor)
        for (std::size_t i = 0; i < coarsest; ++i) {
            const LinkBudget then = budget_at(weights, rate_hz / divisor, limits, qualities[i]);
            if (!then.fits()) continue;
            budget.proposals.push_back({qualities[i], divisor, then.host_mbit_s});
            coarsest = i;
        }
    return budget;
}

}  // namespace vantage
