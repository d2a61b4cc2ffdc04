#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "common/sync/sync_file.h"

namespace vantage {

/// The last synchronisation measurement of a stage (vantage-calib sync), which is kept beside the
/// stage file.
struct SyncProof {
    std::optional<SyncRecord> record;  ///< nothing: not measured, or not readable
    std::string fault;                 ///< why an existing record cannot be read
};

/// Reads the record of a stage. It throws nothing, since a stage can be shown without one.
SyncProof sync_proof_of(const std::filesystem::path& stage_file);

/// Formats the result, such as "measured 3 d ago, 0.05 ms", or that there is none.
std::string sync_words(const SyncProof& proof, std::chrono::system_clock::time_point now);
/// Whether the synchronisation was never measured, not for 30 days, or is wrong.
bool is_doubtful(const SyncProof& proof, std::chrono::system_clock::time_point now);

/// Formats the record for JSON; null if there is none.
nlohmann::ordered_json to_json(const SyncProof& proof, std::chrono::system_clock::time_point now);

}  // namespace vantage
