#include "common/gl/context_group.h"

#include <future>

#include "common/gl/limits.h"

namespace vantage {
namespace {

struct Detached {
    std::shared_ptr<const EglContext> context;
    bool is_software = false;
};

/// Made on a thread of its own, so that nothing becomes current on this one.
Detached detached_context() {
    return std::async(std::launch::async,
                      [] {
                          auto context = std::make_shared<const EglContext>();
                          const bool is_software = GlInfo::query().is_software;
                          eglMakeCurrent(context->display(), EGL_NO_SURFACE, EGL_NO_SURFACE,
                                         EGL_NO_CONTEXT);
                          return Detached{std::move(context), is_software};
                      })
        .get();
}

}  // namespace

ContextGroup::ContextGroup() {
    Detached first = detached_context();
    first_ = std::move(first.context);
    needs_turns_ = first.is_software;
}

ContextGroup::Member ContextGroup::join() {
    const std::lock_guard lock(mutex_);
    return {std::shared_ptr<const EglContext>(new EglContext(EglContext::sharing_with(*first_))),
            generation_};
}

void ContextGroup::renew(std::uint64_t lost) {
    const std::lock_guard lock(mutex_);
    if (lost != generation_) return;
    first_ = detached_context().context;
    ++generation_;
}

}  // namespace vantage
