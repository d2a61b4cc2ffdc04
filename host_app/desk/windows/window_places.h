#pragma once

#include <optional>
#include <span>
#include <vector>

#include "host_app/desk/desk_arrangement.h"

namespace vantage {

/// Returns the work area of every monitor, in GLFW's order.
std::vector<WindowPlace> monitor_places();

/// Returns whether at least 64 x 64 units of a window are on a monitor, enough to grab it.
bool is_on(const WindowPlace& window, const WindowPlace& monitor);

/// Chooses the place of the rigs' window: the first free monitor after the operator's, which is
/// monitor 1, or else a corner of monitor 1. Monitors that the programme fills (`filled`, counted
/// from 1) are never used. Nothing if no monitor is free.
std::optional<WindowPlace> place_for_rigs(std::span<const WindowPlace> monitors,
                                          std::span<const int> filled);

/// Returns whether a window covers a monitor that the programme fills.
bool covers_programme(const WindowPlace& window, std::span<const WindowPlace> monitors,
                      std::span<const int> filled);

}  // namespace vantage
