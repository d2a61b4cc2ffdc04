#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "common/sync/sync_file.h"

namespace vantage {

/// What light last said of a stage's sensors (vantage-calib sync), as it is kept beside its file.
struct SyncProof {
    std::optional<SyncRecord> record;  ///< nothing: there is none that can be read
    std::string fault;                 ///< why one that is there cannot be read
};

/// Throws nothing: a stage without a proof goes on air all the same.
SyncProof sync_proof_of(const std::filesystem::path& stage_file);

/// "proven by light 3 d ago, 0.05 ms", or that it never was, or cannot be read.
std::string sync_words(const SyncProof& proof, std::chrono::system_clock::time_point now);
/// It never was proven, or long ago, or was found wrong.
bool is_doubtful(const SyncProof& proof, std::chrono::system_clock::time_point now);

/// For machines; null where there is none.
nlohmann::ordered_json to_json(const SyncProof& proof, std::chrono::system_clock::time_point now);

}  // namespace vantage
