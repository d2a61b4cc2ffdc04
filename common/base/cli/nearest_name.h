#pragma once

#include <span>
#include <string>
#include <string_view>

namespace vantage {

/// How many letters must be put in, taken out, replaced, or swapped with their neighbour to turn a
/// into b, no part of it twice (the optimal string alignment distance).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The known name that a mistyped one probably stands for; empty if none is near (more than a third
/// of the letters differ). Of equally near ones the first.
std::string nearest_name(std::string_view typed, std::span<const std::string> known);

/// "the nearest is 'x'", or the list of all known names where none is near: the end of a sentence.
std::string suggest_name(std::string_view typed, std::span<const std::string> known);

}  // namespace vantage
