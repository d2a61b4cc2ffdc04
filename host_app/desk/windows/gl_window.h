#pragma once

#include <string>

struct GLFWmonitor;
struct GLFWwindow;

namespace vantage {

/// Hints of the next window: OpenGL ES 3.1, without depth. All others are the defaults.
void hint_gl_window();

/// With the hints as they stand; null: GLFW has the reason. Its context is the window system's own:
/// a processor that draws hands pictures to an X server in shared memory through GLX, and through
/// EGL (Mesa 22.3) by its socket, which costs the server more than drawing them. Where GLX has no
/// OpenGL ES it is EGL's. `monitor`: that it fills; `shared`: whose objects it draws with; or null.
GLFWwindow* create_gl_window(int width, int height, const std::string& title, GLFWmonitor* monitor,
                             GLFWwindow* shared);

/// GLFW's reason for what just failed.
std::string glfw_reason();

/// Makes a window's context current while it lives, and then what was current before.
class CurrentWindow {
  public:
    explicit CurrentWindow(GLFWwindow* window);
    ~CurrentWindow();
    CurrentWindow(const CurrentWindow&) = delete;
    CurrentWindow& operator=(const CurrentWindow&) = delete;

  private:
    GLFWwindow* before_;
};

}  // namespace vantage
