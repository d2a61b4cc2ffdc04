#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host_app/control/hid/wheel_call.h"
#include "host_app/desk/desk_state.h"

namespace vantage {

/// The hands on a wheel's map: which control is theirs, what it is to do, how it is to feel. A
/// command is only written into the map here and never given.
class WheelPanel {
  public:
    enum class Key { up, down, left, right, tab, enter, escape, backspace };

    /// What is shown next, to which it adds what hands are about; nothing: the map is closed.
    void follow(std::optional<DeskWheel>& wheel);
    bool is_open() const { return is_open_; }

    /// A letter of a command's name.
    void type(unsigned codepoint);
    std::optional<WheelCall> press(Key key);
    /// By its place in the map, from 1 on.
    WheelCall press_control(int number);

  private:
    std::optional<WheelCall> press_while_choosing(Key key);
    WheelCall feel(int steps) const;
    void choose(bool is_choosing);
    void narrow();

    bool is_open_ = false, is_choosing_ = false;
    bool has_feel_ = false;  ///< the control in hand is no button
    DeskWheel::Kind kind_ = DeskWheel::Kind::button;
    std::vector<std::string> names_;  ///< of the controls
    std::size_t selected_ = 0;
    std::string typed_;
    std::vector<DeskWheel::Choice> choices_;
    std::size_t chosen_ = 0, feel_in_hand_ = 0;
};

/// All that a control of this kind may do, with what that is.
std::vector<DeskWheel::Choice> wheel_choices(DeskWheel::Kind kind);

}  // namespace vantage
