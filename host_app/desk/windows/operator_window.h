#pragma once

#include <bitset>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/time/time.h"
#include "common/gl/objects/framebuffer.h"
#include "common/gl/shader_library.h"
#include "common/image/image.h"
#include "host_app/desk/desk_arrangement.h"
#include "host_app/desk/desk_screen.h"
#include "host_app/desk/panels/command_prompt.h"
#include "host_app/desk/panels/shot_places.h"
#include "host_app/desk/panels/wheel_panel.h"
#include "host_app/desk/windows/key_caps.h"
#include "host_app/desk/windows/key_guard.h"
#include "host_app/desk/windows/rigs_window.h"
#include "host_app/desk/windows/ui_renderer.h"
#include "host_app/desk/windows/window_screen.h"
#include "host_app/flight/flight_input.h"

struct GLFWwindow;

namespace vantage {

struct ControlCommand;

/// GLFW for as long as it lives. Throws Error with GLFW's reason if there is no display.
class GlfwLibrary {
  public:
    GlfwLibrary();
    ~GlfwLibrary();
    GlfwLibrary(const GlfwLibrary&) = delete;
    GlfwLibrary& operator=(const GlfwLibrary&) = delete;
};

/// The operator's window, with an OpenGL ES 3.1 context that is current on the constructing thread
/// while it lives. One a process. The desk is drawn at a rate of its own, so that where the
/// processor draws it takes no more than a tenth of the time; in between only the programme's
/// picture is.
class OperatorWindow {
  public:
    /// The window has this size, or less where the screen is smaller. Throws Error, with the mend,
    /// if there is no display or no OpenGL ES 3.1 on it.
    OperatorWindow(const std::string& title, int width_px, int height_px);
    ~OperatorWindow();
    OperatorWindow(const OperatorWindow&) = delete;
    OperatorWindow& operator=(const OperatorWindow&) = delete;

    /// Looks at mouse and keyboard; `dt_s` is how long a held key has acted.
    FlightInput poll(double dt_s);
    /// The pulse that the mouse went to on the line of time since the last call.
    std::optional<double> take_seek();
    /// What hands asked of a wheel's map since the last call, in their order.
    std::vector<WheelCall> take_wheel_calls();
    bool closed() const;

    /// Whether show() is to come next, since hands changed what is shown or it is time again.
    bool is_desk_due(MonotonicTime now) const;
    /// Draws the whole desk and shows it. Whether parts and help show is the window's.
    void show(DeskState state);
    /// Of the desk that was shown last only the pictures of programme and preview (null: none) are
    /// new ones, of the same sizes. Under the help they wait for the next show().
    void show_pictures(const Texture& programme, const Texture* preview);

    /// What hands have switched on, and where they have put the window.
    DeskArrangement arrangement() const { return {switches_, place_, rigs_place_}; }
    /// Of a place without a monitor only the size counts.
    void arrange(const DeskArrangement& desk);
    /// Whether points of the stage are shown.
    bool shows_outside() const { return switches_.panels && switches_.outside; }
    /// Where the parts of what was shown last are.
    const DrawnDesk& drawn() const { return drawn_; }
    /// The rigs' own window; null: they are in the desk's row.
    const RigsWindow* rigs_window() const { return rigs_window_.get(); }
    /// What was shown last, the whole desk.
    ColourImage screenshot() const;

  private:
    struct WindowDeleter {
        void operator()(GLFWwindow* window) const;
    };
    static OperatorWindow& of(GLFWwindow* window);
    static void on_key(GLFWwindow* window, int key, int scancode, int action, int modifiers);
    static void on_letter(GLFWwindow* window, unsigned codepoint);
    /// While a command is typed all keys are its.
    void type(int key);
    void take_key(int key, int modifiers);
    /// While a wheel's map is open all keys are its.
    void press_in_panel(int key, bool with_control);
    /// What a command's key has to be asked before it is obeyed; empty: nothing.
    std::string question_of(const ControlCommand& command, int number) const;
    void press_on_picture();
    static void on_button(GLFWwindow* window, int button, int action, int modifiers);
    void press_at_cursor();
    static void on_cursor(GLFWwindow* window, double x, double y);
    void take_cursor(double x, double y);
    static void on_scroll(GLFWwindow* window, double right, double up);
    static void on_change(GLFWwindow* window);
    static void on_moved(GLFWwindow* window, int x, int y);
    static void on_sized(GLFWwindow* window, int width, int height);
    static void on_maximised(GLFWwindow* window, int is_maximised);
    void take_held_keys(double dt_s);
    bool held(int key) const;
    /// Of a letter or sign, wherever this keyboard has it.
    bool held_cap(int letter) const;
    void seek_at_cursor();
    void take_tab(bool with_shift, bool with_control);
    void show_rigs(const DeskState& state);

    GlfwLibrary glfw_;
    KeyCaps caps_;
    std::unique_ptr<GLFWwindow, WindowDeleter> window_;
    ShaderLibrary shaders_;
    std::optional<UiContext> ui_;
    std::optional<UiRenderer> renderer_;
    std::unique_ptr<WindowScreen> screen_;
    std::unique_ptr<RigsWindow> rigs_window_;  ///< null: they are in the desk's row
    std::optional<WindowPlace> rigs_place_;
    DrawnDesk drawn_;
    DeskSwitches switches_;
    WindowPlace place_;
    bool take_runs_ = false, drags_time_ = false, drags_outside_ = false;
    bool is_changed_ = true;  ///< by hands, since the desk was drawn
    KeyGuard guard_;
    CommandPrompt prompt_;
    WheelPanel panel_;
    std::vector<WheelCall> wheel_calls_;
    bool has_unsaved_wheel_ = false;
    std::bitset<shot_places> kept_shots_;

    FlightInput input_;
    std::optional<double> seek_;
    std::bitset<3> drags_;                ///< by button: it went down on the picture
    double cursor_x_ = 0, cursor_y_ = 0;  ///< in pixels of what is shown
    MonotonicTime next_desk_{}, next_desk_in_hand_{};
    double pressed_s_ = -1;  ///< when the left button went down on the picture last
};

}  // namespace vantage
