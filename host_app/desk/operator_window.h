#pragma once

#include <bitset>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/gl/framebuffer.h"
#include "common/gl/shader_library.h"
#include "common/image/image.h"
#include "host_app/desk/operator_panel.h"
#include "host_app/desk/ui_renderer.h"
#include "host_app/flight/flight_input.h"

struct GLFWwindow;

namespace vantage {

/// GLFW for as long as it lives. Throws Error with GLFW's reason if there is no display.
class GlfwLibrary {
  public:
    GlfwLibrary();
    ~GlfwLibrary();
    GlfwLibrary(const GlfwLibrary&) = delete;
    GlfwLibrary& operator=(const GlfwLibrary&) = delete;
};

/// The operator's window, with an OpenGL ES 3.1 context that is current on the constructing thread
/// while it lives. One a process.
class OperatorWindow {
  public:
    /// The window has the picture's size, or less where the screen is smaller. Throws Error, with
    /// the mend, if there is no display or no OpenGL ES 3.1 on it.
    OperatorWindow(const std::string& title, int width_px, int height_px);
    ~OperatorWindow();
    OperatorWindow(const OperatorWindow&) = delete;
    OperatorWindow& operator=(const OperatorWindow&) = delete;

    /// Looks at mouse and keyboard; `dt_s` is how long a held key has acted.
    FlightInput poll(double dt_s);
    bool closed() const;

    /// Draws the operator's screen and shows it. Whether panels and help show is the window's.
    void show(PanelState state);

    /// In place of show(): what is shown stays.
    void leave();

    /// What show() showed last, panels and all.
    ColourImage screenshot() const;

  private:
    struct WindowDeleter {
        void operator()(GLFWwindow* window) const;
    };
    struct Screen {
        Texture texture;
        Framebuffer target;
        Screen(int width_px, int height_px)
            : texture(TextureFormat::rgba8, width_px, height_px), target({&texture}) {}
    };
    static void on_key(GLFWwindow* window, int key, int scancode, int action, int modifiers);
    void take_key(int key);
    void take_press();
    static void on_button(GLFWwindow* window, int button, int action, int modifiers);
    static void on_cursor(GLFWwindow* window, double x, double y);
    void take_cursor(double x, double y);
    void take_wheel();
    void take_held_keys(double dt_s);
    bool held(int key) const;

    GlfwLibrary glfw_;
    std::unique_ptr<GLFWwindow, WindowDeleter> window_;
    ShaderLibrary shaders_;
    std::optional<UiContext> ui_;
    std::optional<UiRenderer> renderer_;
    std::unique_ptr<Screen> screen_;
    FlightInput input_;
    std::bitset<3> drags_;  ///< by button: it went down on the picture
    double cursor_x_ = 0, cursor_y_ = 0;
    double pressed_s_ = -1;  ///< when the left button went down on the picture last
    cv::Size picture_px_;    ///< that is shown
    bool show_panels_ = true, show_help_ = false;
    double end_asked_until_s_ = 0;
};

}  // namespace vantage
