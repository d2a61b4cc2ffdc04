#pragma once

#include <span>
#include <string>
#include <string_view>

namespace vantage {

/// The optimal string alignment distance: the number of insertions, deletions, replacements and
/// swaps of neighbours that turn a into b, where no part is edited twice.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The known name nearest to a mistyped one; the first of equally near ones. Empty if more than a
/// third of the letters differ from every name.
std::string nearest_name(std::string_view typed, std::span<const std::string> known);

/// "the nearest is 'x'", or the list of all known names if none is near. Ends a sentence.
std::string suggest_name(std::string_view typed, std::span<const std::string> known);

}  // namespace vantage
