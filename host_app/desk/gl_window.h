#pragma once

#include <string>

struct GLFWwindow;

namespace vantage {

/// Hints of the next window: OpenGL ES 3.1 through EGL, without depth. All others are the defaults.
void hint_gl_window();

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
