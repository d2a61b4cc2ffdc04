#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"
#include "host_app/desk/desk_arrangement.h"
#include "host_app/desk/windows/pen.h"
#include "host_app/desk/windows/ui_renderer.h"

struct GLFWmonitor;
struct GLFWwindow;

namespace vantage {

struct WindowPlace;

/// Sets GLFW's hints for the next window: OpenGL ES 3.1 without depth, everything else default.
void hint_gl_window();

/// Creates a window with the present hints; null on failure, with GLFW's reason in glfw_reason().
/// The context is the window system's own: through GLX a software renderer passes pictures to the X
/// server in shared memory, whereas EGL (Mesa 22.3) sends them through the socket, which costs the
/// server more than drawing them. If GLX has no OpenGL ES, EGL is used. `monitor` makes the window
/// fill that monitor; `shared` is the window whose objects it shares; both may be null.
GLFWwindow* create_gl_window(int width, int height, const std::string& title, GLFWmonitor* monitor,
                             GLFWwindow* shared);

/// GLFW's reason for the last failure.
std::string glfw_reason();

/// Makes a window's context current during its lifetime and restores the former one afterwards.
class CurrentWindow {
  public:
    explicit CurrentWindow(GLFWwindow* window);
    ~CurrentWindow();
    CurrentWindow(const CurrentWindow&) = delete;
    CurrentWindow& operator=(const CurrentWindow&) = delete;

  private:
    GLFWwindow* before_;
};

/// The off-screen image that a window's content is drawn into before it is shown. It belongs to the
/// window's context.
struct WindowScreen {
    Texture texture;
    Framebuffer target;

    WindowScreen(int width_px, int height_px);
    /// Copies the image to the window and shows it. Precondition: the window's context is current.
    void present(GLFWwindow* window) const;
};

/// Adapts the current ImGui context, its font size and the off-screen image to the window's size.
/// Returns false if the window is minimised and has no size.
bool fit_screen(GLFWwindow* window, UiContext& ui, UiRenderer& renderer,
                std::unique_ptr<WindowScreen>& screen);

/// Moves and resizes a window. A position outside all monitors is ignored.
void put_window(GLFWwindow* window, const WindowPlace& place);

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
