#include "common/gl/objects/fence.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "common/base/error.h"
#include "common/gl/context/context_loss.h"
#include "common/gl/context/driver_lock.h"
#include "common/gl/context/limits.h"

namespace vantage {

Fence Fence::insert() {
    Fence fence;
    fence.sync_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    if (!fence.sync_) fail("the driver has no memory for a fence");
    // An unflushed fence would block other contexts for ever.
    glFlush();
    return fence;
}

Fence::Fence(Fence&& other) noexcept : sync_(std::exchange(other.sync_, nullptr)) {}

Fence& Fence::operator=(Fence&& other) noexcept {
    std::swap(sync_, other.sync_);
    return *this;
}

Fence::~Fence() {
    if (sync_) glDeleteSync(sync_);
}

bool Fence::reached_within(std::chrono::nanoseconds time) const {
    if (!sync_) return true;
    // A poll keeps the driver lock, since getting it back could block.
    std::optional<DriverLock::Pause> pause;
    if (time.count() > 0) pause.emplace();
    const GLenum outcome = glClientWaitSync(sync_, 0, static_cast<GLuint64>(time.count()));
    if (outcome == GL_WAIT_FAILED) fail("the GPU was lost while its work was waited for");
    return outcome != GL_TIMEOUT_EXPIRED;
}

void Fence::wait(const char* doing, std::chrono::nanoseconds limit) const {
    constexpr std::chrono::nanoseconds look_every = std::chrono::seconds(1);
    std::chrono::nanoseconds waited(0);
    for (;;) {
        const std::chrono::nanoseconds slice = std::min(look_every, limit - waited);
        if (reached_within(slice)) return;
        waited += slice;
        require_context(doing);
        const bool is_over = limit == no_limit
                                 ? waited >= hung_after && !GlInfo::query().is_software
                                 : waited >= limit;
        // A program that was stopped meanwhile has not waited.
        if (is_over && !reached())
            throw ContextLost(fmt::format(
                "the GPU has not finished its work within {} ms while {}: it hangs, or its driver "
                "has reset it",
                std::chrono::duration_cast<std::chrono::milliseconds>(waited).count(), doing));
    }
}

void Fence::hold_current_context() const {
    if (sync_) glWaitSync(sync_, 0, GL_TIMEOUT_IGNORED);
}

}  // namespace vantage
