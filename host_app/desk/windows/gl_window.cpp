#include "host_app/desk/windows/gl_window.h"

#include <algorithm>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include "common/base/trace/trace.h"
#include "common/gl/context/limits.h"
#include "host_app/desk/desk_arrangement.h"

namespace vantage {
namespace {

/// The GLFW keys that print a character, by their place on a US keyboard; GLFW numbers them by
/// ASCII.
constexpr std::string_view printing_keys = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789'`,-./;=[]\\";

bool is_letter(int key) { return key >= 'A' && key <= 'Z'; }
bool is_digit(int key) { return key >= '0' && key <= '9'; }

}  // namespace

KeyCaps::KeyCaps(std::function<std::string(int key)> label_of, std::string signs)
    : label_of_(std::move(label_of)), signs_(std::move(signs)) {}

int KeyCaps::cap_of(int key) const {
    const std::string label = label_of_(key);
    if (label.size() != 1) return 0;
    const auto letter = static_cast<unsigned char>(label.front());
    return letter >= 'a' && letter <= 'z' ? letter - 'a' + 'A' : letter;
}

int KeyCaps::meant_by(int key) const {
    const bool prints = key > 0 && key < 128 &&
                        printing_keys.find(static_cast<char>(key)) != std::string_view::npos;
    if (!prints || is_digit(key)) return key;
    const int cap = cap_of(key);
    if (is_letter(cap)) return cap;
    if (cap != 0 && signs_.find(static_cast<char>(cap)) != std::string::npos) return cap;
    // The cap has no sign of a command. The place counts, unless another cap has its sign.
    for (const char other : printing_keys)
        if (other != key && !is_digit(other) && cap_of(other) == key) return -1;
    return key;
}

int KeyCaps::place_of(int meant) const {
    if (meant_by(meant) == meant) return meant;
    for (const char key : printing_keys)
        if (meant_by(key) == meant) return key;
    return -1;
}

std::string KeyCaps::words() const {
    std::string words;
    for (const char meant : printing_keys) {
        const bool is_used = is_letter(meant) || signs_.find(meant) != std::string::npos;
        if (!is_used || meant_by(meant) == meant) continue;
        const int place = place_of(meant);
        words += fmt::format(
            "{}{} is {}", words.empty() ? "" : ", ", meant,
            place < 0 ? std::string("on no key")
                      : fmt::format("where a US keyboard has {}", static_cast<char>(place)));
    }
    return words;
}

namespace {

/// Returns the pixel format of windows if it can be rendered to: a software renderer copies between
/// equal formats in a tenth of the time of a conversion.
TextureFormat window_format() {
    return has_gl_extension("GL_EXT_texture_format_BGRA8888") ? TextureFormat::bgra8
                                                              : TextureFormat::rgba8;
}

}  // namespace

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

WindowScreen::WindowScreen(int width_px, int height_px)
    : texture(window_format(), width_px, height_px), target({&texture}) {}

void WindowScreen::present(GLFWwindow* window) const {
    const cv::Size size = target.size();
    // Row 0 is the top of our pictures and the bottom of the window.
    target.bind();
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glBlitFramebuffer(0, 0, size.width, size.height, 0, size.height, size.width, 0,
                      GL_COLOR_BUFFER_BIT, GL_NEAREST);
    check_gl("showing the operator's desk");
    const TraceSpan span("swap");
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

std::vector<WindowPlace> monitor_places() {
    std::vector<WindowPlace> places;
    int count = 0;
    GLFWmonitor** monitors = glfwGetMonitors(&count);
    for (int i = 0; i < count; ++i) {
        WindowPlace& place = places.emplace_back();
        glfwGetMonitorWorkarea(monitors[i], &place.x, &place.y, &place.width, &place.height);
    }
    return places;
}

bool is_on(const WindowPlace& window, const WindowPlace& monitor) {
    constexpr int min_px = 64;
    const auto shared = [](int from, int length, int other_from, int other_length) {
        return std::min(from + length, other_from + other_length) - std::max(from, other_from);
    };
    return shared(window.x, window.width, monitor.x, monitor.width) >= min_px &&
           shared(window.y, window.height, monitor.y, monitor.height) >= min_px;
}

std::optional<WindowPlace> place_for_rigs(std::span<const WindowPlace> monitors,
                                          std::span<const int> filled) {
    const auto is_free = [&](std::size_t i) {
        return std::find(filled.begin(), filled.end(), static_cast<int>(i) + 1) == filled.end();
    };
    for (std::size_t i = 1; i < monitors.size(); ++i)
        if (is_free(i)) return monitors[i];
    if (monitors.empty() || !is_free(0)) return std::nullopt;
    // Monitor 1 also has the operator's window.
    const WindowPlace& first = monitors[0];
    const int width = first.width / 2, height = first.height / 2;
    return WindowPlace{first.x + first.width - width, first.y + first.height - height, width,
                       height};
}

bool covers_programme(const WindowPlace& window, std::span<const WindowPlace> monitors,
                      std::span<const int> filled) {
    return std::any_of(filled.begin(), filled.end(), [&](int monitor) {
        const auto i = static_cast<std::size_t>(monitor - 1);
        return i < monitors.size() && is_on(window, monitors[i]);
    });
}

}  // namespace vantage
