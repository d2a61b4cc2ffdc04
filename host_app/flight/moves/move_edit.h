#pragma once

#include <cstddef>
#include <optional>

#include "host_app/flight/moves/move.h"

namespace vantage {

// A move is changed by hand while it is flown. Each gives the move that comes of it; a move loops
// on as long as its ends show the same view.

/// With a keyframe behind its end: later by what went by in the take since the last one, or else by
/// `after_s`. Of nothing: a move of one keyframe.
Move appended(const std::optional<Move>& move, const OrbitView& view, std::optional<double> take_s,
              double after_s, const FlightLimits& limits);

/// With this view at a time of it: in place of the keyframe that is there, or as a new one.
Move with_view_at(const Move& move, double time_s, OrbitView view, std::optional<double> take_s);

std::size_t nearest_keyframe(const Move& move, double time_s);
/// Without one of its keyframes; nothing: it was the last.
std::optional<Move> without_keyframe(const Move& move, std::size_t keyframe);
/// With this keyframe, and all behind it, later or earlier; never before the one before it. The
/// first stays.
Move retimed(const Move& move, std::size_t keyframe, double later_s);

}  // namespace vantage
