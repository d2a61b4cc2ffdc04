#include "host_app/desk/windows/window_places.h"

#include <algorithm>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace vantage {

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
