#include "common/gl/context/egl_display.h"

#include <map>
#include <memory>
#include <mutex>
#include <utility>

namespace vantage {
namespace {

struct OpenDisplay {
    explicit OpenDisplay(std::shared_ptr<void> made_from) : native(std::move(made_from)) {}
    int holders = 1;
    std::shared_ptr<void> native;
    std::mutex driver;
};

/// The open displays of the process, as EGL keeps its connections per process.
struct OpenDisplays {
    std::mutex mutex;
    std::map<EGLDisplay, OpenDisplay> all;
};

OpenDisplays& open_displays() {
    static OpenDisplays displays;
    return displays;
}

}  // namespace

EglDisplayHold EglDisplayHold::open(EGLDisplay display, std::shared_ptr<void> native) {
    OpenDisplays& open = open_displays();
    const std::scoped_lock lock(open.mutex);
    auto known = open.all.find(display);
    if (known != open.all.end())
        ++known->second.holders;
    else if (eglInitialize(display, nullptr, nullptr))
        known = open.all.try_emplace(display, std::move(native)).first;
    else
        return {};
    return {display, known->second.driver};
}

EglDisplayHold EglDisplayHold::join(EGLDisplay display) {
    OpenDisplays& open = open_displays();
    const std::scoped_lock lock(open.mutex);
    OpenDisplay& known = open.all.at(display);
    ++known.holders;
    return {display, known.driver};
}

EglDisplayHold::EglDisplayHold(EglDisplayHold&& other) noexcept
    : display_(std::exchange(other.display_, EGL_NO_DISPLAY)),
      driver_(std::exchange(other.driver_, nullptr)) {}

EglDisplayHold& EglDisplayHold::operator=(EglDisplayHold&& other) noexcept {
    std::swap(display_, other.display_);
    std::swap(driver_, other.driver_);
    return *this;
}

EglDisplayHold::~EglDisplayHold() {
    if (!held()) return;
    OpenDisplays& open = open_displays();
    const std::scoped_lock lock(open.mutex);
    const auto known = open.all.find(display_);
    if (--known->second.holders > 0) return;
    eglTerminate(display_);
    open.all.erase(known);
}

}  // namespace vantage
