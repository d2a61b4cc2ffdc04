#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host_app/control/hid/wheel_input.h"
#include "host_app/desk/desk_state.h"

namespace vantage {

/// The keyboard input of an open wheel map: it selects a control, assigns a command to it and
/// adjusts its response. Commands chosen here are written into the map and never executed.
class WheelPanel {
  public:
    enum class Key { up, down, left, right, tab, enter, escape, backspace };

    /// Takes the map that is shown next and adds the state of the input to it; nothing: the map is
    /// closed.
    void follow(std::optional<DeskWheel>& wheel);
    bool is_open() const { return is_open_; }

    /// Adds a character to the filter of the commands.
    void type(unsigned codepoint);
    std::optional<WheelCall> press(Key key);
    /// Selects a control by its place in the map, from 1 on.
    WheelCall press_control(int number);

  private:
    std::optional<WheelCall> press_while_choosing(Key key);
    WheelCall feel(int steps) const;
    void choose(bool is_choosing);
    void narrow();

    bool is_open_ = false, is_choosing_ = false;
    bool has_feel_ = false;  ///< the selected control is not a button
    DeskWheel::Kind kind_ = DeskWheel::Kind::button;
    std::vector<std::string> names_;  ///< of the controls
    std::size_t selected_ = 0;
    std::string typed_;
    std::vector<DeskWheel::Choice> choices_;
    std::size_t chosen_ = 0, feel_in_hand_ = 0;
};

/// Returns the commands that a control of this kind can have, with their descriptions.
std::vector<DeskWheel::Choice> wheel_choices(DeskWheel::Kind kind);

}  // namespace vantage
