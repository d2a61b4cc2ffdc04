#include "host_app/desk/windows/rigs_window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include "common/base/error.h"
#include "host_app/desk/panels/desk_parts.h"
#include "host_app/desk/windows/gl_window.h"

namespace vantage {

struct RigsWindow::Drawing {
    UiContext ui;
    UiRenderer renderer;
    std::unique_ptr<WindowScreen> screen;

    Drawing(const ShaderLibrary& shaders, float letter_px) : ui(letter_px), renderer(shaders) {}
};

void RigsWindow::WindowDeleter::operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }

RigsWindow::RigsWindow(GLFWwindow* operators, const ShaderLibrary& shaders,
                       const std::optional<WindowPlace>& place) {
    hint_gl_window();
    // Keyboard focus stays at the operator's window.
    glfwWindowHint(GLFW_FOCUSED, GLFW_FALSE);
    glfwWindowHint(GLFW_FOCUS_ON_SHOW, GLFW_FALSE);
    place_ = place.value_or(WindowPlace{});
    window_.reset(
        create_gl_window(place_.width, place_.height, "Vantage rigs", nullptr, operators));
    if (!window_) fail("cannot open a window for the rigs ({})", glfw_reason());
    if (place) {
        put_window(window_.get(), *place);
    } else if (const std::vector<WindowPlace> monitors = monitor_places(); monitors.size() > 1) {
        // With one monitor the window manager chooses the place.
        put_window(window_.get(), *place_for_rigs(monitors, {}));
    }
    const CurrentWindow current(window_.get());
    glfwSwapInterval(0);
    const UiContext::Kept kept;
    drawing_ = std::make_unique<Drawing>(
        shaders,
        letter_height_px(static_cast<float>(place_.width), static_cast<float>(place_.height), 1));
}

RigsWindow::~RigsWindow() {
    const CurrentWindow current(window_.get());
    const UiContext::Kept kept;
    drawing_.reset();
}

void RigsWindow::give_keys(void* user, OnKey on_key, OnLetter on_letter) {
    glfwSetWindowUserPointer(window_.get(), user);
    glfwSetKeyCallback(window_.get(), on_key);
    glfwSetCharCallback(window_.get(), on_letter);
}

bool RigsWindow::closed() const { return glfwWindowShouldClose(window_.get()) != 0; }

void RigsWindow::leave(std::span<const int> filled) {
    if (filled.empty()) return;
    const std::vector<WindowPlace> monitors = monitor_places();
    if (!covers_programme(place_, monitors, filled)) return;
    if (const std::optional<WindowPlace> place = place_for_rigs(monitors, filled))
        put_window(window_.get(), *place);
}

void RigsWindow::show(const DeskState& state) {
    glfwGetWindowPos(window_.get(), &place_.x, &place_.y);
    glfwGetWindowSize(window_.get(), &place_.width, &place_.height);
    leave(state.programme_monitors);
    // This context waits for the textures that the operator's context uploads.
    const Fence pictures = Fence::insert();
    const CurrentWindow current(window_.get());
    const UiContext::Kept kept;
    pictures.hold_current_context();
    drawing_->ui.make_current();
    if (!fit_screen(window_.get(), drawing_->ui, drawing_->renderer, drawing_->screen)) return;
    ImGui::NewFrame();
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const Pen pen(drawing_->ui.fonts());
    const DeskRect whole{0, 0, size.x, size.y};
    pen.fill(whole, palette::ground);
    draw_multiview(pen, whole,
                   best_rig_rows(size.x, size.y, pen.em(), static_cast<int>(state.rigs.size())),
                   state);
    ImGui::Render();
    drawing_->renderer.draw(*ImGui::GetDrawData(), drawing_->screen->target);
    drawing_->screen->present(window_.get());
}

ColourImage RigsWindow::screenshot() const {
    const CurrentWindow current(window_.get());
    return drawing_->screen ? ColourImage(drawing_->screen->texture.download()) : ColourImage();
}

}  // namespace vantage
