#include "common/base/cli/version.h"

namespace vantage {

std::string_view version() { return VANTAGE_VERSION; }

}  // namespace vantage
