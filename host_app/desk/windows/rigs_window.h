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

/// The rigs' pictures and state in a window of their own, as large as they get: on the second
/// monitor where there is one, and never on one that the programme fills. Its context shares the
/// pictures of the operator's window, which is current whenever this is made, shown or destroyed,
/// and is so afterwards.
class RigsWindow {
  public:
    /// Throws Error if it cannot be opened.
    RigsWindow(GLFWwindow* operators, const ShaderLibrary& shaders,
               const std::optional<WindowPlace>& place);
    ~RigsWindow();
    RigsWindow(const RigsWindow&) = delete;
    RigsWindow& operator=(const RigsWindow&) = delete;

    using OnKey = void (*)(GLFWwindow*, int key, int scancode, int action, int modifiers);
    using OnLetter = void (*)(GLFWwindow*, unsigned codepoint);
    /// Who types in it is heard there, with this as the window's user pointer.
    void give_keys(void* user, OnKey on_key, OnLetter on_letter);
    bool closed() const;
    void show(const DeskState& state);
    /// As it was when it was shown last.
    const WindowPlace& place() const { return place_; }
    /// What was shown last.
    ColourImage screenshot() const;

  private:
    struct WindowDeleter {
        void operator()(GLFWwindow* window) const;
    };
    /// Monitors that the programme fills.
    void leave(std::span<const int> filled);

    /// Objects of the window's context.
    struct Drawing;

    std::unique_ptr<GLFWwindow, WindowDeleter> window_;
    WindowPlace place_;
    std::unique_ptr<Drawing> drawing_;
};

}  // namespace vantage
