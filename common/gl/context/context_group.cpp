#include "common/gl/context/context_group.h"

#include <future>

namespace vantage {
namespace {

/// Creates a context on a thread of its own, so that nothing becomes current on this thread.
std::shared_ptr<const EglContext> detached_context() {
    return std::async(std::launch::async,
                      [] {
                          auto context = std::make_shared<const EglContext>();
                          eglMakeCurrent(context->display(), EGL_NO_SURFACE, EGL_NO_SURFACE,
                                         EGL_NO_CONTEXT);
                          return context;
                      })
        .get();
}

}  // namespace

ContextGroup::ContextGroup() : first_(detached_context()), driver_(first_->driver()) {}

ContextGroup::Member ContextGroup::join() {
    const std::lock_guard lock(mutex_);
    return {std::shared_ptr<const EglContext>(new EglContext(EglContext::sharing_with(*first_))),
            generation_};
}

void ContextGroup::renew(std::uint64_t lost) {
    const std::lock_guard lock(mutex_);
    if (lost != generation_) return;
    first_ = detached_context();
    ++generation_;
}

}  // namespace vantage
