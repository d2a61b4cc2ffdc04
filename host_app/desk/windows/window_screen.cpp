#include "host_app/desk/windows/window_screen.h"

#include <algorithm>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include "common/gl/context/limits.h"
#include "host_app/desk/desk_layout.h"
#include "host_app/desk/windows/window_places.h"

namespace vantage {
namespace {

/// As windows have it, where that can be drawn to: from one format to another a software renderer
/// shows pixel by pixel, and within one it copies, in a tenth of the time.
TextureFormat window_format() {
    return has_gl_extension("GL_EXT_texture_format_BGRA8888") ? TextureFormat::bgra8
                                                              : TextureFormat::rgba8;
}

}  // namespace

WindowScreen::WindowScreen(int width_px, int height_px)
    : texture(window_format(), width_px, height_px), target({&texture}) {}

void WindowScreen::present(GLFWwindow* window) const {
    const cv::Size size = target.size();
    // Our pictures have their top in row 0, the window's has its bottom there.
    target.bind();
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glBlitFramebuffer(0, 0, size.width, size.height, 0, size.height, size.width, 0,
                      GL_COLOR_BUFFER_BIT, GL_NEAREST);
    check_gl("showing the operator's desk");
    glfwSwapBuffers(window);
}

bool fit_screen(GLFWwindow* window, UiContext& ui, UiRenderer& renderer,
                std::unique_ptr<WindowScreen>& screen) {
    int width_px = 0, height_px = 0;
    glfwGetFramebufferSize(window, &width_px, &height_px);
    if (width_px < 1 || height_px < 1) return false;
    const auto width = static_cast<float>(width_px), height = static_cast<float>(height_px);
    float scale = 1, scale_y = 1;
    glfwGetWindowContentScale(window, &scale, &scale_y);
    if (const float letter_px = letter_height_px(width, height, scale);
        letter_px != ui.letter_px()) {
        ui.set_letter_px(letter_px);
        renderer.take_fonts();
    }
    ImGui::GetIO().DisplaySize = {width, height};
    if (!screen || screen->target.size() != cv::Size(width_px, height_px))
        screen = std::make_unique<WindowScreen>(width_px, height_px);
    return true;
}

void put_window(GLFWwindow* window, const WindowPlace& place) {
    glfwSetWindowSize(window, place.width, place.height);
    const std::vector<WindowPlace> monitors = monitor_places();
    if (std::any_of(monitors.begin(), monitors.end(),
                    [&](const WindowPlace& monitor) { return is_on(place, monitor); }))
        glfwSetWindowPos(window, place.x, place.y);
    if (place.is_maximised) glfwMaximizeWindow(window);
}

}  // namespace vantage
