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
#include "host_app/desk/panels/command_prompt.h"
#include "host_app/desk/panels/desk_parts.h"
#include "host_app/desk/panels/wheel_panel.h"
#include "host_app/desk/windows/gl_window.h"
#include "host_app/desk/windows/rigs_window.h"
#include "host_app/desk/windows/ui_renderer.h"
#include "host_app/flight/flight_input.h"

struct GLFWwindow;

namespace vantage {

struct ControlCommand;

/// Initialises GLFW for its lifetime. Throws Error with GLFW's reason if there is no display.
class GlfwLibrary {
  public:
    GlfwLibrary();
    ~GlfwLibrary();
    GlfwLibrary(const GlfwLibrary&) = delete;
    GlfwLibrary& operator=(const GlfwLibrary&) = delete;
};

/// The operator's window with the desk, and its mouse and keyboard input. Its OpenGL ES 3.1 context
/// is current on the constructing thread during its lifetime; there is one window per process. The
/// desk is drawn at its own rate, so that a software renderer spends at most a twentieth of its
/// time on it; in between only the pictures are updated.
class OperatorWindow {
  public:
    /// Opens a window of this size, or smaller if the screen is smaller. Throws Error with the
    /// remedy if there is no display, or no OpenGL ES 3.1 on it.
    OperatorWindow(const std::string& title, int width_px, int height_px);
    ~OperatorWindow();
    OperatorWindow(const OperatorWindow&) = delete;
    OperatorWindow& operator=(const OperatorWindow&) = delete;

    /// Reads mouse and keyboard. `dt_s` is the time since the last call, for keys that are held.
    FlightInput poll(double dt_s);
    /// Returns the pulse that was clicked on the time line since the last call.
    std::optional<double> take_seek();
    /// Returns the changes to a wheel's map since the last call, in order.
    std::vector<WheelCall> take_wheel_calls();
    bool closed() const;

    /// Returns whether show() is due: after operator input, or after the desk's period.
    bool is_desk_due(MonotonicTime now) const;
    /// Draws the whole desk with the parts that are switched on, and shows it.
    void show(DeskState state);
    /// Updates only the pictures of programme and preview (null: none) of the desk that was shown
    /// last; their sizes must not have changed. Does nothing under an overlay.
    void show_pictures(const Texture& programme, const Texture* preview);

    /// The operator's arrangement of desk and windows.
    DeskArrangement arrangement() const { return {switches_, place_, rigs_place_}; }
    /// Applies an arrangement. A position outside all monitors is ignored.
    void arrange(const DeskArrangement& desk);
    /// Whether the 3-D view of the stage is shown.
    bool shows_outside() const { return switches_.panels && switches_.outside; }
    /// The positions of the parts as they were drawn last.
    const DrawnDesk& drawn() const { return drawn_; }
    /// The rigs' window; null: the rigs are in the desk's row.
    const RigsWindow* rigs_window() const { return rigs_window_.get(); }
    /// The desk as it was shown last.
    ColourImage screenshot() const;

  private:
    struct WindowDeleter {
        void operator()(GLFWwindow* window) const;
    };
    static OperatorWindow& of(GLFWwindow* window);
    static void on_key(GLFWwindow* window, int key, int scancode, int action, int modifiers);
    static void on_letter(GLFWwindow* window, unsigned codepoint);
    /// Handles a key while the command line is open.
    void type(int key);
    void take_key(int key, int modifiers);
    /// Handles a key while a wheel's map is open.
    void press_in_panel(int key, bool with_control);
    /// The question that a command's key must confirm; empty: none.
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
    /// Whether the key is held whose cap has this letter or sign.
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
    std::unique_ptr<RigsWindow> rigs_window_;  ///< null: the rigs are in the desk's row
    std::optional<WindowPlace> rigs_place_;
    DrawnDesk drawn_;
    DeskSwitches switches_;
    WindowPlace place_;
    bool take_runs_ = false, drags_time_ = false, drags_outside_ = false;
    bool is_changed_ = true;  ///< there was operator input since the desk was drawn
    KeyGuard guard_;
    CommandPrompt prompt_;
    WheelPanel panel_;
    std::vector<WheelCall> wheel_calls_;
    bool has_unsaved_wheel_ = false;
    std::bitset<shot_places> kept_shots_;

    FlightInput input_;
    std::optional<double> seek_;
    std::bitset<3> drags_;                ///< by button: pressed on the picture
    double cursor_x_ = 0, cursor_y_ = 0;  ///< pixels
    MonotonicTime next_desk_{}, next_desk_in_hand_{};
    double pressed_s_ = -1;  ///< time of the left button's last press on the picture
};

}  // namespace vantage
