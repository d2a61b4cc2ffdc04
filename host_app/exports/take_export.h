#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "common/take/take_reader.h"

namespace vantage {

struct Moment;

/// A form that other programs read. `write` makes a file, or a folder, of one moment.
struct ExportFormat {
    const char* name;
    const char* words;      ///< for people
    const char* extension;  ///< of a moment's file; empty: a folder
    void (*write)(const Moment& moment, const std::filesystem::path& path);
};
std::span<const ExportFormat> export_formats();
/// Throws Error that lists the names there are.
const ExportFormat& find_export_format(const std::string& name);

/// Pulses of a take: every so many from `from` to before `to`.
struct TakePart {
    std::uint64_t from = 0, to = ~std::uint64_t{0}, every = 1;
};

struct ExportStats {
    std::uint64_t written = 0;
    std::uint64_t there = 0;    ///< that an earlier export wrote
    std::uint64_t damaged = 0;  ///< frames that are left out, since their bytes are not right
};

/// Writes moments into `folder`, which is made. A moment is there when it is whole, and one that is
/// there is left as it is: what was broken off goes on where it was. Moments are numbered by their
/// pulses from the beginning of the take. Throws Error if the folder holds something else, or there
/// is nothing to write.
ExportStats export_moments(const TakeReader& take, const ExportFormat& format, const TakePart& part,
                           const std::filesystem::path& folder,
                           const std::function<void(double)>& progress = {});

/// Writes the flight: `folder`/camera.csv and camera.freed. Throws Error likewise.
ExportStats export_camera(const TakeReader& take, const TakePart& part,
                          const std::filesystem::path& folder);

}  // namespace vantage
