#pragma once

#include "common/base/error.h"

namespace vantage {

/// The GPU was reset or removed. The context draws nothing any more, and all objects of its group
/// are lost.
class ContextLost : public Error {
  public:
    using Error::Error;
};

/// Throws ContextLost, with `doing` in its sentence, if the current context is lost. Drivers
/// without EGL_EXT_create_context_robustness never report it.
void require_context(const char* doing);

}  // namespace vantage
