#include "host_app/desk/windows/screen_windows.h"

#include <algorithm>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include "common/base/error.h"
#include "common/gl/objects/framebuffer.h"
#include "host_app/desk/windows/gl_window.h"

namespace vantage {

/// A full-screen window. Its context is current during construction, draw() and destruction.
class ScreenWindows::Window {
  public:
    explicit Window(int monitor) {
        int count = 0;
        GLFWmonitor** monitors = glfwGetMonitors(&count);
        if (monitor > count) fail("there is no monitor {}: this display has {}", monitor, count);
        GLFWmonitor* shown_on = monitors[monitor - 1];
        const GLFWvidmode* mode = glfwGetVideoMode(shown_on);
        // The monitor keeps its video mode.
        hint_gl_window();
        glfwWindowHint(GLFW_RED_BITS, mode->redBits);
        glfwWindowHint(GLFW_GREEN_BITS, mode->greenBits);
        glfwWindowHint(GLFW_BLUE_BITS, mode->blueBits);
        glfwWindowHint(GLFW_REFRESH_RATE, mode->refreshRate);
        // Keyboard focus stays at the operator's window.
        glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE);
        glfwWindowHint(GLFW_FOCUSED, GLFW_FALSE);
        glfwWindowHint(GLFW_FOCUS_ON_SHOW, GLFW_FALSE);
        window_ =
            create_gl_window(mode->width, mode->height, "Vantage programme", shown_on, nullptr);
        if (!window_) fail("cannot open a window with OpenGL ES 3.1 on monitor {}", monitor);
        glfwSetInputMode(window_, GLFW_CURSOR, GLFW_CURSOR_HIDDEN);
        glfwMakeContextCurrent(window_);
        glfwSwapInterval(0);
    }
    ~Window() {
        if (!window_) return;
        glfwMakeContextCurrent(window_);
        source_.reset();
        glfwDestroyWindow(window_);
    }
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// False after the monitor was unplugged.
    bool is_on_monitor() const { return glfwGetWindowMonitor(window_) != nullptr; }

    void draw(const ColourImage& picture) {
        glfwMakeContextCurrent(window_);
        if (!source_ || source_->texture.size() != picture.size())
            source_ = std::make_unique<Source>(picture.cols, picture.rows);
        source_->texture.upload(picture);
        int width = 0, height = 0;
        glfwGetFramebufferSize(window_, &width, &height);
        const float scale = std::min(static_cast<float>(width) / static_cast<float>(picture.cols),
                                     static_cast<float>(height) / static_cast<float>(picture.rows));
        const int shown_width = cvRound(scale * static_cast<float>(picture.cols));
        const int shown_height = cvRound(scale * static_cast<float>(picture.rows));
        const int left = (width - shown_width) / 2, bottom = (height - shown_height) / 2;
        source_->framebuffer.bind();
        glBindFramebuffer(GL_READ_FRAMEBUFFER, source_->framebuffer.name());
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
        glViewport(0, 0, width, height);
        glClearColor(0, 0, 0, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        // Row 0 is the top of our pictures and the bottom of the window.
        glBlitFramebuffer(0, 0, picture.cols, picture.rows, left, bottom + shown_height,
                          left + shown_width, bottom, GL_COLOR_BUFFER_BIT, GL_LINEAR);
        glfwSwapBuffers(window_);
    }

  private:
    struct Source {
        Texture texture;
        Framebuffer framebuffer;
        Source(int width_px, int height_px)
            : texture(TextureFormat::rgba8, width_px, height_px), framebuffer({&texture}) {}
    };
    GLFWwindow* window_ = nullptr;
    std::unique_ptr<Source> source_;
};

ScreenWindows::ScreenWindows(bool has_glfw) : has_glfw_(has_glfw) {}

ScreenWindows::~ScreenWindows() {
    GLFWwindow* before = has_glfw_ ? glfwGetCurrentContext() : nullptr;
    windows_.clear();
    if (has_glfw_) glfwMakeContextCurrent(before);
}

std::vector<int> ScreenWindows::monitors() const {
    std::vector<int> monitors;
    for (const auto& [feed, window] : windows_) monitors.push_back(feed->monitor());
    return monitors;
}

void ScreenWindows::open(ScreenFeed& feed) {
    try {
        if (!has_glfw_ && !glfw_) glfw_.emplace();
        windows_[&feed] = std::make_unique<Window>(feed.monitor());
        feed.show();
    } catch (const Error& error) {
        windows_.erase(&feed);
        feed.fail(error.what());
    }
}

void ScreenWindows::show(ScreenFeed& feed) {
    Window& window = *windows_.at(&feed);
    if (!window.is_on_monitor()) {
        windows_.erase(&feed);
        feed.fail(
            fmt::format("monitor {} is gone: it was unplugged or switched off", feed.monitor()));
        return;
    }
    if (const ColourImage picture = feed.take(); !picture.empty()) window.draw(picture);
}

void ScreenWindows::follow(std::span<const std::shared_ptr<ScreenFeed>> feeds) {
    const auto is_idle = [&](const std::shared_ptr<ScreenFeed>& feed) {
        return feed->state() != ScreenFeed::State::asked && !windows_.contains(feed.get());
    };
    if (std::all_of(feeds.begin(), feeds.end(), is_idle)) return;
    // Without an operator's window the current context may be that of a window that closes here.
    GLFWwindow* before = has_glfw_ ? glfwGetCurrentContext() : nullptr;
    for (const std::shared_ptr<ScreenFeed>& feed : feeds) {
        switch (feed->state()) {
            case ScreenFeed::State::asked:
                open(*feed);
                break;
            case ScreenFeed::State::shown:
                show(*feed);
                break;
            case ScreenFeed::State::closed:
            case ScreenFeed::State::failed:
                windows_.erase(feed.get());
                break;
        }
    }
    if (!has_glfw_ && glfw_) glfwPollEvents();
    if (has_glfw_) glfwMakeContextCurrent(before);
}

}  // namespace vantage
