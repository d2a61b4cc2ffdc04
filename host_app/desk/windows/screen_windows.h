#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "host_app/desk/windows/operator_window.h"
#include "host_app/output/screen_feed.h"

namespace vantage {

/// The full-screen outputs: windows that show nothing but the programme, letterboxed on a monitor
/// of another shape. All calls come from one thread, that of the operator's window if there is one.
class ScreenWindows {
  public:
    /// `has_glfw`: there is an OperatorWindow, which outlives this object and polls the events.
    explicit ScreenWindows(bool has_glfw);
    ~ScreenWindows();
    ScreenWindows(const ScreenWindows&) = delete;
    ScreenWindows& operator=(const ScreenWindows&) = delete;

    /// Opens and closes windows as the feeds request and shows their new pictures. Failures are
    /// reported to the feed. The context that was current is restored.
    void follow(std::span<const std::shared_ptr<ScreenFeed>> feeds);
    /// The monitors with an open window, counted from 1.
    std::vector<int> monitors() const;

  private:
    class Window;
    void open(ScreenFeed& feed);
    void show(ScreenFeed& feed);

    bool has_glfw_;
    std::optional<GlfwLibrary> glfw_;
    std::map<const ScreenFeed*, std::unique_ptr<Window>> windows_;
};

}  // namespace vantage
