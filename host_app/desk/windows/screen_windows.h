#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "host_app/desk/windows/operator_window.h"
#include "host_app/output/screen_feed.h"

namespace vantage {

/// Shows pictures on the whole of monitors, without anything else, letterboxed where a monitor has
/// another shape. Everything on one thread, that of the operator's window where there is one.
class ScreenWindows {
  public:
    /// `has_glfw`: an OperatorWindow is there, outlives this, and looks at events.
    explicit ScreenWindows(bool has_glfw);
    ~ScreenWindows();
    ScreenWindows(const ScreenWindows&) = delete;
    ScreenWindows& operator=(const ScreenWindows&) = delete;

    /// Opens and closes windows as the feeds ask, and shows what came since the last call. What
    /// goes wrong with one is told to its feed. The context that was current is so afterwards.
    void follow(std::span<const std::shared_ptr<ScreenFeed>> feeds);
    /// That windows are on now, counted from 1.
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
