#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "common/take/take_reader.h"
#include "host_app/control/tracking/freed_message.h"

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

/// The camera of a programme tick.
CameraState camera_of(const CameraRecord& record);

/// The FreeD message of a tick's camera.
std::array<std::byte, freed_bytes> freed_message(const CameraRecord& camera);

/// Writes one line per tick: time code, seconds since the first tick, position, rotation as angles
/// and as a quaternion of world_from_camera (OpenCV's axes), and lens.
void write_camera_csv(const TakeReader& take, std::span<const CameraRecord> cameras,
                      const std::filesystem::path& file);
/// Writes the FreeD messages of all ticks in sequence.
void write_camera_freed(std::span<const CameraRecord> cameras, const std::filesystem::path& file);

/// Serves decoded frame sets of a take to another program on this computer, without copies of the
/// pixels: the decoders write into shared memory, which that program maps.
///
/// The first line on `out` describes the take as JSON. Each request is a line on `in`:
/// `{"pulse": N}` for a frame set, or `{"cameras": true}` for the camera of every tick. Each answer
/// is a line on `out`: either `{"error": SENTENCE}`, or an object with `fd`, the descriptor of the
/// shared memory in this process, its `bytes`, its number `memory`, and the place and shape of
/// every array in it. The descriptor is valid until the next request, and a mapping of it as long
/// as it is held. A request with `"released": [NUMBER...]` says which memory is no longer mapped,
/// so that it can be used again. Returns at the end of `in`. Throws Error if the take's head is
/// damaged.
void serve_take(const TakeReader& take, std::istream& in, std::ostream& out);

}  // namespace vantage
