#pragma once

#include <cstddef>
#include <optional>

#include "host_app/flight/moves/move.h"

namespace vantage {

// Edits of a move. Each returns the edited move. A move keeps looping as long as both ends show the
// same view.

/// Appends a keyframe. Its time is the last one's plus the time that passed in the take since then,
/// or plus `after_s` without a take. Without a move the result has this keyframe only.
Move appended(const std::optional<Move>& move, const OrbitView& view, std::optional<double> take_s,
              double after_s, const FlightLimits& limits);

/// Replaces the view of the keyframe at a time, or adds a keyframe there.
Move with_view_at(const Move& move, double time_s, OrbitView view, std::optional<double> take_s);

std::size_t nearest_keyframe(const Move& move, double time_s);
/// Removes a keyframe; empty if it was the only one.
std::optional<Move> without_keyframe(const Move& move, std::size_t keyframe);
/// Shifts a keyframe and all later ones in time, but never to before the preceding keyframe. The
/// first keyframe stays at 0.
Move retimed(const Move& move, std::size_t keyframe, double later_s);

}  // namespace vantage
