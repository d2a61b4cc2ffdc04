#pragma once

#include <optional>
#include <span>
#include <vector>

#include "host_app/desk/desk_arrangement.h"

namespace vantage {

/// What windows may cover of every monitor, in GLFW's order, which counts them.
std::vector<WindowPlace> monitor_places();

/// Whether so much of a window is on a monitor that it can be taken hold of, or is in the way.
bool is_on(const WindowPlace& window, const WindowPlace& monitor);

/// Where the rigs' window goes: to the first free monitor but the operator's, which is the first,
/// or else into a corner of that; never onto one that the programme fills (`filled`, counted from
/// 1). Nothing: there is no such place.
std::optional<WindowPlace> place_for_rigs(std::span<const WindowPlace> monitors,
                                          std::span<const int> filled);

/// Whether it is in the programme's way.
bool covers_programme(const WindowPlace& window, std::span<const WindowPlace> monitors,
                      std::span<const int> filled);

}  // namespace vantage
