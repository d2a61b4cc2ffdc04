#include "tests/support/source_folder.h"

namespace vantage {

std::filesystem::path source_folder() { return VANTAGE_SOURCE_DIR; }

}  // namespace vantage
