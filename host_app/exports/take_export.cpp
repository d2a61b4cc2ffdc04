#include "host_app/exports/take_export.h"

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/atomic_file.h"
#include "common/base/error.h"
#include "common/base/folder.h"
#include "common/take/take_pulses.h"
#include "host_app/exports/camera_files.h"
#include "host_app/exports/moment.h"
#include "host_app/exports/moment_folders.h"
#include "host_app/exports/point_files.h"

namespace vantage {
namespace {

constexpr std::array<ExportFormat, 4> formats{{
    {"ply", "coloured points, a PLY file a moment", ".ply", write_ply},
    {"glb", "coloured points, a glTF file a moment", ".glb", write_glb},
    {"training", "pictures, depth, transforms.json and a COLMAP model, a folder a moment", "",
     write_training_folder},
    {"views", "a view set for vantage render, a folder a moment", "", write_view_set},
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

/// Where an export of the take goes: a new folder, or one that such an export was begun in.
void claim(const std::filesystem::path& folder, const TakeReader& take, const std::string& format) {
    make_folder(folder);
    const nlohmann::ordered_json claim{
        {"version", 1},
        {"origin_tai_ns", take.facts().origin.time_since_epoch().count()},
        {"program", take.facts().program},
        {"bytes", take.bytes()},
        {"as", format}};
    const std::string text = claim.dump(1) + '\n';
    const std::filesystem::path file = folder / "export.json";
    if (std::filesystem::exists(file)) {
        constexpr std::size_t most_bytes = 1 << 16;
        const std::vector<std::byte> there = read_file(file, most_bytes);
        if (std::string_view(reinterpret_cast<const char*>(there.data()), there.size()) != text)
            fail(
                "{} holds another export already, of another take or as something else: give a "
                "new folder",
                folder.string());
        return;
    }
    if (!std::filesystem::is_empty(folder))
        fail("{} holds other files: give a new folder", folder.string());
    write_file_atomically(file, std::as_bytes(std::span(text)));
}

}  // namespace

std::span<const ExportFormat> export_formats() { return formats; }

const ExportFormat& find_export_format(const std::string& name) {
    std::string names;
    for (const ExportFormat& format : formats) {
        if (format.name == name) return format;
        names += std::string(", ") + format.name;
    }
    fail("a take is not exported as '{}'; there are camera, film{}", name, names);
}

ExportBooks export_moments(const TakeReader& take, const ExportFormat& format, const TakePart& part,
                           const std::filesystem::path& folder,
                           const std::function<void(double)>& progress) {
    const std::vector<std::uint64_t> pulses = pulses_of(take, part);
    if (pulses.empty()) fail("{} is not written: no frame is in that part", folder.string());
    claim(folder, take, format.name);
    const std::uint64_t first = pulse_span_of(take).first;
    MomentReader reader(take);
    ExportBooks books;
    for (std::size_t i = 0; i < pulses.size(); ++i) {
        if (progress) progress(static_cast<double>(i) / static_cast<double>(pulses.size()));
        const std::string name = fmt::format("{:06}{}", pulses[i] - first, format.extension);
        if (std::filesystem::exists(folder / name)) {
            ++books.there;
            continue;
        }
        const std::filesystem::path partial = folder / ("partial-" + name);
        std::error_code error;
        std::filesystem::remove_all(partial, error);
        const Moment moment = reader.at(pulses[i]);
        books.damaged += moment.damaged;
        if (moment.views.empty()) continue;
        format.write(moment, partial);
        std::filesystem::rename(partial, folder / name, error);
        if (error) fail("cannot write {}: {}", (folder / name).string(), error.message());
        ++books.written;
    }
    return books;
}

ExportBooks export_camera(const TakeReader& take, const TakePart& part,
                          const std::filesystem::path& folder) {
    std::vector<CameraRecord> cameras;
    std::uint64_t ticks = 0;
    for (const CameraRecord& camera : take.cameras())
        if (camera.pulse >= part.from && camera.pulse < part.to && ticks++ % part.every == 0)
            cameras.push_back(camera);
    if (cameras.empty()) fail("{} has no camera in that part", take.path().string());
    claim(folder, take, "camera");
    write_camera_csv(take, cameras, folder / "camera.csv");
    write_camera_freed(cameras, folder / "camera.freed");
    return {cameras.size(), 0, 0};
}

}  // namespace vantage
