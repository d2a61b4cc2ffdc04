#pragma once

#include "common/base/error.h"

namespace vantage {

/// The device is gone (unplugged, or its driver stopped); it may come back under the same name.
class DeviceLost : public Error {
  public:
    using Error::Error;
};

}  // namespace vantage
