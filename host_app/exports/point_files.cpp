#include <array>
#include <bit>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/colour/colour_correction.h"
#include "host_app/exports/moment.h"

namespace vantage {
namespace {

static_assert(std::endian::native == std::endian::little, "the files are little-endian");

void append(std::string& bytes, const void* from, std::size_t count) {
    bytes.append(static_cast<const char*>(from), count);
}
void append_number(std::string& bytes, std::uint32_t number) {
    append(bytes, &number, sizeof number);
}

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

std::string ply_of(const std::vector<SurfacePoint>& points, const Triangles& triangles) {
    std::string bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
        "property float x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\n",
        points.size());
    if (!triangles.empty())
        bytes += fmt::format("element face {}\nproperty list uchar int vertex_indices\n",
                             triangles.size());
    bytes += "end_header\n";
    for (const SurfacePoint& point : points) {
        append(bytes, point.position_m.data(), 3 * sizeof(float));
        append(bytes, point.rgb.val, 3);
    }
    for (const std::array<std::uint32_t, 3>& triangle : triangles) {
        bytes += '\3';
        append(bytes, triangle.data(), sizeof triangle);
    }
    return bytes;
}

}  // namespace

void write_ply(const std::vector<SurfacePoint>& points, const std::filesystem::path& file) {
    write_text_atomically(file, ply_of(points, {}));
}

void write_ply(const Moment& moment, const std::filesystem::path& file) {
    write_text_atomically(file, ply_of(surface_points(moment, 1), surface_triangles(moment)));
}

void write_glb(const Moment& moment, const std::filesystem::path& file) {
    const std::vector<SurfacePoint> points = surface_points(moment, 1);
    if (points.empty()) fail("{} is not written: no rig has depth at that moment", file.string());
    std::string positions, colours;
    Eigen::Vector3f least = points.front().position_m, most = least;
    for (const SurfacePoint& point : points) {
        append(positions, point.position_m.data(), 3 * sizeof(float));
        // glTF's vertex colours are linear light, and each element is aligned to four bytes.
        for (int i = 0; i < 3; ++i) {
            constexpr double most_8_bit = 255, most_16_bit = 65535;
            const auto linear = static_cast<std::uint16_t>(
                std::lround(most_16_bit * srgb_decode(point.rgb[i] / most_8_bit)));
            append(colours, &linear, sizeof linear);
        }
        colours.append(2, '\xff');
        least = least.cwiseMin(point.position_m);
        most = most.cwiseMax(point.position_m);
    }
    const Triangles triangles = surface_triangles(moment);
    const std::size_t triangles_bytes = triangles.size() * sizeof triangles.front();
    constexpr int of_float = 5126, of_16_bit = 5123, of_32_bit = 5125, as_points = 0,
                  as_triangles = 4, array_buffer = 34962, index_buffer = 34963;
    nlohmann::ordered_json primitive{{"attributes", {{"POSITION", 0}, {"COLOR_0", 1}}},
                                     {"material", 0},
                                     {"mode", triangles.empty() ? as_points : as_triangles}};
    if (!triangles.empty()) primitive["indices"] = 2;
    nlohmann::ordered_json json{
        {"asset", {{"version", "2.0"}, {"generator", "vantage"}}},
        {"extensionsUsed", {"KHR_materials_unlit"}},
        {"scene", 0},
        {"scenes", {{{"nodes", {0}}}}},
        {"nodes", {{{"mesh", 0}, {"name", fmt::format("pulse {}", moment.pulse)}}}},
        {"materials",
         {{{"name", "as filmed"},
           {"doubleSided", true},
           {"extensions", {{"KHR_materials_unlit", nlohmann::ordered_json::object()}}}}}},
        {"meshes", {{{"primitives", {primitive}}}}},
        {"accessors",
         {{{"bufferView", 0},
           {"componentType", of_float},
           {"count", points.size()},
           {"type", "VEC3"},
           {"min", {least[0], least[1], least[2]}},
           {"max", {most[0], most[1], most[2]}}},
          {{"bufferView", 1},
           {"componentType", of_16_bit},
           {"normalized", true},
           {"count", points.size()},
           {"type", "VEC4"}}}},
        {"bufferViews",
         {{{"buffer", 0},
           {"byteOffset", 0},
           {"byteLength", positions.size()},
           {"target", array_buffer}},
          {{"buffer", 0},
           {"byteOffset", positions.size()},
           {"byteLength", colours.size()},
           {"target", array_buffer}}}},
        {"buffers", {{{"byteLength", positions.size() + colours.size() + triangles_bytes}}}}};
    if (!triangles.empty()) {
        json["accessors"].push_back({{"bufferView", 2},
                                     {"componentType", of_32_bit},
                                     {"count", 3 * triangles.size()},
                                     {"type", "SCALAR"}});
        json["bufferViews"].push_back({{"buffer", 0},
                                       {"byteOffset", positions.size() + colours.size()},
                                       {"byteLength", triangles_bytes},
                                       {"target", index_buffer}});
    }
    std::string text = json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    constexpr std::uint32_t header_bytes = 12, chunk_header_bytes = 8, version = 2;
    const std::size_t binary_bytes = positions.size() + colours.size() + triangles_bytes;
    const std::size_t all = header_bytes + 2 * chunk_header_bytes + text.size() + binary_bytes;
    if (all > ~std::uint32_t{0})
        fail("{} is not written: {} points are more than a GLB file holds", file.string(),
             points.size());
    std::string bytes = "glTF";
    append_number(bytes, version);
    append_number(bytes, static_cast<std::uint32_t>(all));
    append_number(bytes, static_cast<std::uint32_t>(text.size()));
    bytes += "JSON" + text;
    append_number(bytes, static_cast<std::uint32_t>(binary_bytes));
    bytes += std::string("BIN\0", 4) + positions + colours;
    append(bytes, triangles.data(), triangles_bytes);
    write_text_atomically(file, bytes);
}

}  // namespace vantage
