#pragma once

#include <memory>

#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"
#include "host_app/desk/windows/style.h"
#include "host_app/desk/windows/ui_renderer.h"

struct GLFWwindow;

namespace vantage {

struct WindowPlace;

/// What a window shows, which is drawn here first. Of the window's context.
struct WindowScreen {
    Texture texture;
    Framebuffer target;

    WindowScreen(int width_px, int height_px);
    /// Precondition: the window's context is current.
    void present(GLFWwindow* window) const;
};

/// Gives the current ImGui context the window's size, with letters to go with it, and makes the
/// screen anew where it has another. False: the window is put away and has no size.
bool fit_screen(GLFWwindow* window, UiContext& ui, UiRenderer& renderer,
                std::unique_ptr<WindowScreen>& screen);

/// Moves and sizes it. Of a place without a monitor only the size counts.
void put_window(GLFWwindow* window, const WindowPlace& place);

}  // namespace vantage
