#pragma once

namespace vantage {

/// Places that the desk has for shots, as many as there are keys.
constexpr int shot_places = 9;

}  // namespace vantage
