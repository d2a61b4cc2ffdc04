#pragma once

#include <bit>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "host_app/control/hid/jog_event.h"

namespace vantage {

/// Converts masks of held buttons into events for the buttons that changed.
class HeldButtons {
  public:
    /// `name_of` returns the name of a bit's button; an empty name means no button.
    void update(std::uint64_t mask, const std::function<std::string(int bit)>& name_of,
                std::vector<JogEvent>& events) {
        for (std::uint64_t changed = mask ^ held_; changed != 0; changed &= changed - 1) {
            const int bit = std::countr_zero(changed);
            std::string name = name_of(bit);
            if (!name.empty())
                events.push_back({JogKind::button, std::move(name), (mask >> bit & 1) ? 1.0 : 0.0});
        }
        held_ = mask;
    }

  private:
    std::uint64_t held_ = 0;
};

/// Remembers axis positions and creates events only for axes that moved, since some devices repeat
/// themselves.
class AxisPosition {
  public:
    void update(double value, const std::string& name, std::vector<JogEvent>& events) {
        if (value != value_) events.push_back({JogKind::axis, name, value});
        value_ = value;
    }

  private:
    double value_ = 0;
};

}  // namespace vantage
