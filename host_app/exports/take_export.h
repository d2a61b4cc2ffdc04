#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "common/take/take_reader.h"

namespace vantage {

struct Moment;

/// An export format. `write` writes a file, or a folder, of one moment.
struct ExportFormat {
    const char* name;
    const char* words;      ///< description for people
    const char* extension;  ///< of a moment's file; empty: a folder
    void (*write)(const Moment& moment, const std::filesystem::path& path);
};
std::span<const ExportFormat> export_formats();
/// Throws Error with the known names.
const ExportFormat& find_export_format(const std::string& name);

/// A range of a take's pulses: every n-th from `from` to before `to`.
struct TakePart {
    std::uint64_t from = 0, to = ~std::uint64_t{0}, every = 1;
};

struct ExportStats {
    std::uint64_t written = 0;
    std::uint64_t there = 0;    ///< written by an earlier export
    std::uint64_t damaged = 0;  ///< frames left out because they are damaged
};

/// Writes moments into `folder`. A moment appears when it is complete, and an existing one is kept,
/// so that an interrupted export resumes. Moments are numbered by their pulses since the beginning
/// of the take. Throws Error if the folder contains something else, or there is nothing to write.
ExportStats export_moments(const TakeReader& take, const ExportFormat& format, const TakePart& part,
                           const std::filesystem::path& folder,
                           const std::function<void(double)>& progress = {});

/// Writes the recorded camera: `folder`/camera.csv and camera.freed. Throws Error likewise.
ExportStats export_camera(const TakeReader& take, const TakePart& part,
                          const std::filesystem::path& folder);

/// Creates the folder of an export, or resumes the export that was begun in it: export.json in the
/// folder identifies the take and `what`. Throws Error if the folder contains something else.
/// Several processes may call it at a time.
void claim_folder(const std::filesystem::path& folder, const TakeReader& take,
                  const nlohmann::ordered_json& what);

}  // namespace vantage
