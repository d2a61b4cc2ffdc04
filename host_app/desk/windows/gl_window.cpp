#include "host_app/desk/windows/gl_window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace vantage {

void hint_gl_window() {
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CLIENT_API, GLFW_OPENGL_ES_API);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 1);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
}

GLFWwindow* create_gl_window(int width, int height, const std::string& title, GLFWmonitor* monitor,
                             GLFWwindow* shared) {
    const auto create = [&](int context_api) {
        glfwWindowHint(GLFW_CONTEXT_CREATION_API, context_api);
        return glfwCreateWindow(width, height, title.c_str(), monitor, shared);
    };
    if (shared) return create(glfwGetWindowAttrib(shared, GLFW_CONTEXT_CREATION_API));
    GLFWwindow* window = create(GLFW_NATIVE_CONTEXT_API);
    if (!window) (void)glfwGetError(nullptr);
    return window ? window : create(GLFW_EGL_CONTEXT_API);
}

std::string glfw_reason() {
    const char* words = nullptr;
    if (glfwGetError(&words) == GLFW_NO_ERROR || !words) return "no reason given";
    std::string reason = words;
    while (!reason.empty() && (reason.back() == '.' || reason.back() == '\n')) reason.pop_back();
    return reason;
}

CurrentWindow::CurrentWindow(GLFWwindow* window) : before_(glfwGetCurrentContext()) {
    glfwMakeContextCurrent(window);
}

CurrentWindow::~CurrentWindow() { glfwMakeContextCurrent(before_); }

}  // namespace vantage
