#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "common/take/take_reader.h"

namespace vantage {

/// Makes the folder of an export of the take, or takes up one that such an export was begun in:
/// export.json in it says of which take, and `what`. Throws Error if the folder holds something
/// else. Several processes may do so at a time.
void claim_folder(const std::filesystem::path& folder, const TakeReader& take,
                  const nlohmann::ordered_json& what);

}  // namespace vantage
