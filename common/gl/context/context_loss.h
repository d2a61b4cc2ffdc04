#pragma once

#include "common/base/error.h"

namespace vantage {

/// The GPU was reset, or is gone: the context draws nothing any more, and all that it and those
/// that it shares with held is lost.
class ContextLost : public Error {
  public:
    using Error::Error;
};

/// Throws ContextLost if that has befallen this thread's context. A driver that cannot tell of
/// resets (EGL_EXT_create_context_robustness) never says so.
void require_context(const char* doing);

}  // namespace vantage
