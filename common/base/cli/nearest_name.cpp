#include "common/base/cli/nearest_name.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace vantage {

std::size_t edit_distance(std::string_view a, std::string_view b) {
    const std::size_t width = b.size() + 1;
    std::vector<std::size_t> table((a.size() + 1) * width);
    const auto at = [&](std::size_t i, std::size_t j) -> std::size_t& {
        return table[i * width + j];
    };
    for (std::size_t i = 0; i <= a.size(); ++i) at(i, 0) = i;
    for (std::size_t j = 0; j <= b.size(); ++j) at(0, j) = j;
    for (std::size_t i = 1; i <= a.size(); ++i)
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = at(i - 1, j - 1) + (a[i - 1] == b[j - 1] ? 0 : 1);
            at(i, j) = std::min({at(i - 1, j) + 1, at(i, j - 1) + 1, replaced});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                at(i, j) = std::min(at(i, j), at(i - 2, j - 2) + 1);
        }
    return at(a.size(), b.size());
}

std::string nearest_name(std::string_view typed, std::span<const std::string> known) {
    std::string best;
    std::size_t best_distance = 0;
    for (const std::string& name : known) {
        const std::size_t distance = edit_distance(typed, name);
        const std::size_t bearable =
            std::max<std::size_t>(1, (std::max(typed.size(), name.size()) + 1) / 3);
        if (distance <= bearable && (best.empty() || distance < best_distance)) {
            best = name;
            best_distance = distance;
        }
    }
    return best;
}

std::string suggest_name(std::string_view typed, std::span<const std::string> known) {
    const std::string nearest = nearest_name(typed, known);
    if (!nearest.empty()) return fmt::format("the nearest is '{}'", nearest);
    return fmt::format("the ones there are: {}", fmt::join(known, ", "));
}

}  // namespace vantage
