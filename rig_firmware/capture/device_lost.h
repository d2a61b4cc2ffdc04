#pragma once

#include "common/base/error.h"

namespace vantage {

/// Error for a device that is gone (unplugged, or its driver stopped). It may come back under the
/// same name.
class DeviceLost : public Error {
  public:
    using Error::Error;
};

}  // namespace vantage
