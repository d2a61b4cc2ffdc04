#pragma once

#include <memory>
#include <optional>
#include <span>

#include "common/gl/objects/fence.h"
#include "common/gl/objects/framebuffer.h"
#include "common/gl/shader_library.h"
#include "common/image/image.h"
#include "host_app/desk/desk_arrangement.h"
#include "host_app/desk/desk_state.h"
#include "host_app/desk/windows/ui_renderer.h"

struct GLFWwindow;

namespace vantage {

/// A window with the rigs' pictures and state, as large as possible. It opens on the second monitor
/// if there is one, and never on a monitor that the programme fills. Its context shares the
/// textures of the operator's window, whose context must be current for construction, show() and
/// destruction, and is current afterwards.
class RigsWindow {
  public:
    /// Throws Error if the window cannot be opened.
    RigsWindow(GLFWwindow* operators, const ShaderLibrary& shaders,
               const std::optional<WindowPlace>& place);
    ~RigsWindow();
    RigsWindow(const RigsWindow&) = delete;
    RigsWindow& operator=(const RigsWindow&) = delete;

    using OnKey = void (*)(GLFWwindow*, int key, int scancode, int action, int modifiers);
    using OnLetter = void (*)(GLFWwindow*, unsigned codepoint);
    /// Forwards keyboard input to these callbacks, with `user` as the window's user pointer.
    void give_keys(void* user, OnKey on_key, OnLetter on_letter);
    bool closed() const;
    void show(const DeskState& state);
    /// The window's place when it was shown last.
    const WindowPlace& place() const { return place_; }
    /// The content that was shown last.
    ColourImage screenshot() const;

  private:
    struct WindowDeleter {
        void operator()(GLFWwindow* window) const;
    };
    /// Moves the window away from the monitors that the programme fills.
    void leave(std::span<const int> filled);

    /// Objects of the window's context.
    struct Drawing;

    std::unique_ptr<GLFWwindow, WindowDeleter> window_;
    WindowPlace place_;
    std::unique_ptr<Drawing> drawing_;
};

}  // namespace vantage
