#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"
#include "host_app/desk/desk_arrangement.h"
#include "host_app/desk/windows/pen.h"
#include "host_app/desk/windows/ui_renderer.h"

struct GLFWmonitor;
struct GLFWwindow;

namespace vantage {

/// Maps keys to the letters and signs that are printed on their caps. GLFW numbers keys by their
/// place on a US keyboard, so that on a French keyboard its key M is labelled "," and its key ";"
/// is labelled M.
///
/// Digits go by their place, since keyboards that need Shift for digits have them in the same
/// place. A sign that no cap has goes by its place, unless the cap there has a letter or the sign
/// of another command. The letters of a keyboard without Latin letters go by their place.
class KeyCaps {
  public:
    /// `label_of` returns what is printed on the cap of a GLFW key, without Shift; empty if
    /// nothing. `signs` are the characters other than letters and digits that commands use.
    explicit KeyCaps(std::function<std::string(int key)> label_of, std::string signs);

    /// Returns the GLFW key of a US keyboard that has the same cap; `key` itself if its cap has no
    /// letter or sign of a command; -1 if the key has no meaning.
    int meant_by(int key) const;
    /// Returns the GLFW key whose cap has this letter or sign; -1 if there is none.
    int place_of(int meant) const;
    /// Lists the letters and signs that lie elsewhere than on a US keyboard, such as "M is where a
    /// US keyboard has ;". Empty if there are none.
    std::string words() const;

  private:
    /// Returns the letter (upper case) or sign on the cap; 0 if there is none or it is not ASCII.
    int cap_of(int key) const;

    std::function<std::string(int)> label_of_;
    std::string signs_;
};

/// Confirmation of keys that end or delete something: such a key acts only when it is pressed a
/// second time while its question is shown. Times are GLFW's seconds.
class KeyGuard {
  public:
    static constexpr double asks_for_s = 3;  ///< how long a question is shown

    /// Returns whether this question is already shown; otherwise shows it.
    bool confirms(const std::string& question, double now_s) {
        const bool is_again = question == question_ && now_s < until_s_;
        question_ = is_again ? std::string() : question;
        until_s_ = now_s + asks_for_s;
        return is_again;
    }
    /// The question that is shown now; empty: none.
    std::string question(double now_s) const {
        return now_s < until_s_ ? question_ : std::string();
    }

  private:
    std::string question_;
    double until_s_ = 0;
};

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
