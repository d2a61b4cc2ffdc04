#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "common/take/take_reader.h"

namespace vantage {

/// Creates the folder of an export, or resumes the export that was begun in it: export.json in the
/// folder identifies the take and `what`. Throws Error if the folder contains something else.
/// Several processes may call it at a time.
void claim_folder(const std::filesystem::path& folder, const TakeReader& take,
                  const nlohmann::ordered_json& what);

}  // namespace vantage
