#include "host_app/exports/take_export.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/files/folder.h"
#include "common/base/time/timecode.h"
#include "common/take/take_pulses.h"
#include "host_app/exports/moment.h"

namespace vantage {
namespace {

constexpr std::array<ExportFormat, 6> formats{{
    {"ply", "coloured points and surfaces, a PLY file per moment", ".ply", write_ply},
    {"glb", "coloured surfaces, a glTF file per moment", ".glb", write_glb},
    {"exr", "colour as linear light and depth, a folder of OpenEXR files per moment", "",
     write_exr_folder},
    {"training", "images, depth, transforms.json and a COLMAP model, a folder per moment", "",
     write_training_folder},
    {"views", "a view set for vantage render, a folder per moment", "", write_view_set},
    {"mpeg", "an MPEG view set (TMIV, RVS), a folder per moment", "", write_mpeg_views},
}};

std::vector<std::uint64_t> pulses_of(const TakeReader& take, const TakePart& part) {
    std::set<std::uint64_t> pulses;
    for (std::size_t rig = 0; rig < take.facts().rigs.size(); ++rig)
        for (const TakeReader::Frame& frame : take.frames(rig)) pulses.insert(frame.pulse);
    std::vector<std::uint64_t> wanted;
    for (const std::uint64_t pulse : pulses)
        if (pulse >= part.from && pulse < part.to && (pulse - part.from) % part.every == 0)
            wanted.push_back(pulse);
    return wanted;
}

constexpr const char* name = "export.json";

bool holds_others(const std::filesystem::path& folder) {
    const std::filesystem::directory_iterator files(folder);
    return std::any_of(begin(files), end(files), [](const auto& entry) {
        return !entry.path().filename().string().starts_with(name);
    });
}

constexpr double deg = 180 / std::numbers::pi;

}  // namespace

std::span<const ExportFormat> export_formats() { return formats; }

const ExportFormat& find_export_format(const std::string& name) {
    std::string names;
    for (const ExportFormat& format : formats) {
        if (format.name == name) return format;
        names += std::string(", ") + format.name;
    }
    fail("a take cannot be exported as '{}'; the formats are camera, film, otio, edl{}", name,
         names);
}

ExportStats export_moments(const TakeReader& take, const ExportFormat& format, const TakePart& part,
                           const std::filesystem::path& folder,
                           const std::function<void(double)>& progress) {
    const std::vector<std::uint64_t> pulses = pulses_of(take, part);
    if (pulses.empty()) fail("{} is not written: the range has no frames", folder.string());
    claim_folder(folder, take, format.name);
    const std::uint64_t first = pulse_span_of(take).first;
    MomentReader reader(take);
    ExportStats stats;
    for (std::size_t i = 0; i < pulses.size(); ++i) {
        if (progress) progress(static_cast<double>(i) / static_cast<double>(pulses.size()));
        const std::string name = fmt::format("{:06}{}", pulses[i] - first, format.extension);
        if (std::filesystem::exists(folder / name)) {
            ++stats.there;
            continue;
        }
        // A moment is written in a folder of its own. If the process is killed, the next one
        // removes all of it.
        const std::filesystem::path partial = folder / ("partial-" + name);
        std::error_code error;
        std::filesystem::remove_all(partial, error);
        const Moment moment = reader.at(pulses[i]);
        stats.damaged += moment.damaged;
        if (moment.views.empty()) continue;
        make_folder(partial);
        format.write(moment, partial / name);
        std::filesystem::rename(partial / name, folder / name, error);
        if (error) fail("cannot write {}: {}", (folder / name).string(), error.message());
        std::filesystem::remove_all(partial, error);
        ++stats.written;
    }
    return stats;
}

ExportStats export_camera(const TakeReader& take, const TakePart& part,
                          const std::filesystem::path& folder) {
    std::vector<CameraRecord> cameras;
    std::uint64_t ticks = 0;
    for (const CameraRecord& camera : take.cameras())
        if (camera.pulse >= part.from && camera.pulse < part.to && ticks++ % part.every == 0)
            cameras.push_back(camera);
    if (cameras.empty()) fail("{} has no recorded camera in that range", take.path().string());
    claim_folder(folder, take, "camera");
    write_camera_csv(take, cameras, folder / "camera.csv");
    write_camera_freed(cameras, folder / "camera.freed");
    return {cameras.size(), 0, 0};
}

void claim_folder(const std::filesystem::path& folder, const TakeReader& take,
                  const nlohmann::ordered_json& what) {
    make_folder(folder);
    const nlohmann::ordered_json claim{
        {"version", 1},
        {"origin_tai_ns", take.facts().origin.time_since_epoch().count()},
        {"program", take.facts().program},
        {"bytes", take.bytes()},
        {"as", what}};
    const std::string text = claim.dump(1) + '\n';
    const std::filesystem::path file = folder / name;
    // Several processes may begin parts of one export at a time. If another one has created
    // export.json since the first check, its files are not foreign.
    if (!std::filesystem::exists(file) && holds_others(folder) && !std::filesystem::exists(file))
        fail("{} contains other files: choose a new name", folder.string());
    if (!std::filesystem::exists(file)) write_text_atomically(file, text);
    constexpr std::size_t most_bytes = 1 << 16;
    if (read_text_file(file, most_bytes) != text)
        fail(
            "{} contains another export, of another take or format: choose a new name, or delete "
            "it",
            folder.string());
}

CameraState camera_of(const CameraRecord& record) {
    return {record.world_from_camera, record.field_of_view_rad, record.focus_m};
}

std::array<std::byte, freed_bytes> freed_message(const CameraRecord& camera) {
    return encode_freed(freed_camera(camera_of(camera), 1));
}

void write_camera_csv(const TakeReader& take, std::span<const CameraRecord> cameras,
                      const std::filesystem::path& file) {
    const TimecodeClock clock(take.facts().pulse_rate_hz);
    std::string text =
        "tick,pulse,timecode,time_s,x_m,y_m,z_m,pan_deg,tilt_deg,roll_deg,qw,qx,qy,qz,"
        "field_of_view_deg,focus_m\n";
    for (const CameraRecord& camera : cameras) {
        const PanTiltRoll turn = pan_tilt_roll_of(camera.world_from_camera);
        const Eigen::Vector3d at = camera.world_from_camera.translation();
        const Eigen::Quaterniond q(camera.world_from_camera.linear());
        text += fmt::format(
            "{},{},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f},{:.9f},"
            "{:.6f},{:.6f}\n",
            camera.tick, camera.pulse, clock.of_pulse(camera.pulse, take.facts().tai_offset_s),
            std::chrono::duration<double>(camera.time - cameras.front().time).count(), at.x(),
            at.y(), at.z(), turn.pan_rad * deg, turn.tilt_rad * deg, turn.roll_rad * deg, q.w(),
            q.x(), q.y(), q.z(), camera.field_of_view_rad * deg, camera.focus_m);
    }
    write_text_atomically(file, text);
}

void write_camera_freed(std::span<const CameraRecord> cameras, const std::filesystem::path& file) {
    std::vector<std::byte> bytes;
    for (const CameraRecord& camera : cameras) {
        const auto message = freed_message(camera);
        bytes.insert(bytes.end(), message.begin(), message.end());
    }
    write_file_atomically(file, bytes);
}

}  // namespace vantage
